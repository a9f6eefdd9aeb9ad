# cmake -DBAKE=program -DSOURCE=folder -DTILES="N49E020.hgt ..." -DOUT=file.eyt -P bake_once.cmake
# Bakes some tiles of a folder of elevation unless a database newer than the program is there. They are copied beside it
# first, into a folder of its name: the tests judge by the same tiles. Without the source it does nothing: the tests that
# need the database say so.
if(NOT IS_DIRECTORY ${SOURCE})
  message(STATUS "${SOURCE} is not there: nothing is baked")
  return()
endif()
if(EXISTS ${OUT} AND NOT ${BAKE} IS_NEWER_THAN ${OUT})
  message(STATUS "${OUT} is up to date")
  return()
endif()
string(REGEX REPLACE "\\.eyt$" "" folder ${OUT})
file(MAKE_DIRECTORY ${folder})
separate_arguments(TILES)
foreach(tile ${TILES})
  file(COPY ${SOURCE}/${tile} DESTINATION ${folder})
endforeach()
# Under another name until it is whole.
file(REMOVE ${OUT} ${OUT}.baking ${OUT}.baking-wal ${OUT}.baking-shm)
execute_process(COMMAND ${BAKE} --elevation ${folder} --out ${OUT}.baking RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "eyepoint-bake failed: ${failed}")
endif()
file(RENAME ${OUT}.baking ${OUT})
