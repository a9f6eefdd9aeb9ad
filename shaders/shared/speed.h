// The speed reference's mesh, for C++ and GLSL: 15,000 triangles over the picture, 32 pixels each at 800x600.
#ifndef EYE_SHARED_SPEED_H
#define EYE_SHARED_SPEED_H

#define EYE_SPEED_COLUMNS 100
#define EYE_SPEED_ROWS 75
#define EYE_SPEED_VERTICES (EYE_SPEED_COLUMNS * EYE_SPEED_ROWS * 6)

#endif
