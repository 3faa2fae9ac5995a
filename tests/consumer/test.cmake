# cmake -D BUILD= -D WORK= -D GENERATOR= -D COMPILER= -D LAUNCHER= -D BUILD_TYPE= -D FLAGS= -P test.cmake
# Installs the build tree BUILD into a prefix of its own, runs the program from there, and builds and runs this folder's
# project against it, all from nothing: a file that is no longer installed must not be found from an earlier run.

file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/raytruth --version)
run(${CMAKE_COMMAND}
    -S ${CMAKE_CURRENT_LIST_DIR}
    -B ${WORK}/build
    -G ${GENERATOR}
    -D CMAKE_PREFIX_PATH=${WORK}/prefix
    -D CMAKE_CXX_COMPILER=${COMPILER}
    -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
    -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/build/documents_consumer)
run(${WORK}/build/module_consumer)
