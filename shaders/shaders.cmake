# Compiles every shader to SPIR-V, validates it and embeds it as a C++ header (shaders/NAME.h, an array kNAME), so that a
# program needs no files beside it. NAME is the file's name with its dots as underscores: terrain_vert, sky_frag.
file(GLOB EYE_SHADERS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.frag
  ${CMAKE_SOURCE_DIR}/shaders/*.comp)
file(GLOB EYE_SHADER_HEADERS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/shared/*.h)
set(embedded)
foreach(shader ${EYE_SHADERS})
  get_filename_component(file ${shader} NAME)
  string(REPLACE "." "_" name ${file})
  set(spv ${CMAKE_BINARY_DIR}/spirv/${file}.spv)
  set(header ${CMAKE_BINARY_DIR}/embedded/spirv/${name}.h)
  add_custom_command(OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/spirv ${CMAKE_BINARY_DIR}/embedded/spirv
    COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR}/shaders -o ${spv} ${shader}
    COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spv}
    COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR}/shaders --vn k_${name} -o ${header} ${shader}
    DEPENDS ${shader} ${EYE_SHADER_HEADERS}
    COMMENT "SPIR-V ${file}" VERBATIM)
  list(APPEND embedded ${header})
endforeach()
add_custom_target(eye_shaders DEPENDS ${embedded})
add_dependencies(eye_render eye_shaders)
target_include_directories(eye_render PUBLIC ${CMAKE_BINARY_DIR}/embedded)
