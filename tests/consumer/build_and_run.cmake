# SPDX-License-Identifier: BSD-3-Clause
# cmake -D BUILD=… -D SOURCE=… -D SCRATCH=… -D PYTHON=… -D COMPILER=… -D FLAGS=… -D CONFIGURATION=… -P build_and_run.cmake
# Installs the build into SCRATCH, moves the installed tree, and then uses it as a stranger would: a project that
# calls find_package, and the program, which must find its data beside itself.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/first)
file(RENAME ${SCRATCH}/first ${SCRATCH}/moved)

# The archive must know nothing of the tree that it was built in.
file(STRINGS ${SCRATCH}/moved/lib/libpetzval.a paths REGEX "${TREE}/data")
if(paths)
  message(FATAL_ERROR "the installed library holds paths of the source tree: ${paths}")
endif()

unset(ENV{PETZVAL_DATA})
run(${PYTHON} ${SOURCE}/snippets.py ${SCRATCH}/moved/include ${TREE}/docs/CPP.md ${SCRATCH}/snippets)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -G Ninja -D EXAMPLES=${TREE}/examples -D SNIPPETS=${SCRATCH}/snippets -D CMAKE_PREFIX_PATH=${SCRATCH}/moved
    -D CMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" -D CMAKE_BUILD_TYPE=${CONFIGURATION})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer)
run(${CMAKE_COMMAND} -E chdir ${SCRATCH} ${SCRATCH}/build/altered_lens)
foreach(gap 6.008 6.200 6.400)
  if(NOT EXISTS ${SCRATCH}/gap-${gap}.png)
    message(FATAL_ERROR "altered_lens wrote no gap-${gap}.png")
  endif()
endforeach()

# The how-to page of C++, as it stands, where somebody has installed into $HOME/petzval.
file(MAKE_DIRECTORY ${SCRATCH}/stranger)
file(CREATE_LINK ${SCRATCH}/moved ${SCRATCH}/stranger/petzval SYMBOLIC)
run(${CMAKE_COMMAND} -E env HOME=${SCRATCH}/stranger CXX=${COMPILER} "CXXFLAGS=${FLAGS}" CMAKE_GENERATOR=Ninja
    ${PYTHON} ${TREE}/tests/docs/run_examples.py ${SCRATCH}/moved/bin/petzval ${TREE}/docs/HOWTO_CPP.md)

if(EXISTS ${SCRATCH}/moved/bin/petzval)
  # A lens that is nowhere but in the moved tree: found there or not at all.
  set(lenses ${SCRATCH}/moved/share/petzval/lenses)
  file(COPY_FILE ${lenses}/edmund-54852.json ${lenses}/only-installed.json)
  run(${SCRATCH}/moved/bin/petzval lens info only-installed)
endif()
file(REMOVE_RECURSE ${SCRATCH})
