# cmake -DBAKE=program -DSOURCE=folder -DOUT=file.eyt -P bake_once.cmake
# Bakes a folder of elevation unless a database newer than the program is there. Without the folder it does nothing: the
# tests that need the database say so.
if(NOT IS_DIRECTORY ${SOURCE})
  message(STATUS "${SOURCE} is not there: nothing is baked")
  return()
endif()
if(EXISTS ${OUT} AND NOT ${BAKE} IS_NEWER_THAN ${OUT})
  message(STATUS "${OUT} is up to date")
  return()
endif()
get_filename_component(folder ${OUT} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
# Under another name until it is whole.
file(REMOVE ${OUT} ${OUT}.baking ${OUT}.baking-wal ${OUT}.baking-shm)
execute_process(COMMAND ${BAKE} --elevation ${SOURCE} --out ${OUT}.baking RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "eyepoint-bake failed: ${failed}")
endif()
file(RENAME ${OUT}.baking ${OUT})
