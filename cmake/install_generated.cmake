# Run by `cmake --install`: what depends on the prefix (links, units, configuration, pages) and what the installed programs
# make (manuals, completions). In: source, build, version, programs, scripts (paths below source).
set(root $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})  # file(INSTALL) puts DESTDIR before its destination by itself

file(MAKE_DIRECTORY ${root}/bin)
# Interpreted programs find what they import beside themselves, behind the link too.
foreach(script ${scripts})
  cmake_path(GET script FILENAME name)
  message(STATUS "Installing: ${root}/bin/${name}")
  file(CREATE_LINK ../share/leonav/${script} ${root}/bin/${name} SYMBOLIC)
  list(APPEND programs ${name})
endforeach()
file(MAKE_DIRECTORY ${root}/lib/python3/dist-packages)
file(CREATE_LINK ../../../share/leonav/tools/python/leonav ${root}/lib/python3/dist-packages/leonav SYMBOLIC)

# /usr keeps its configuration in /etc; any other prefix is a tree of its own.
set(leonav_bin ${CMAKE_INSTALL_PREFIX}/bin)
set(leonav_etc ${CMAKE_INSTALL_PREFIX}/etc/leonav)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(leonav_etc /etc/leonav)
endif()
set(leonav_share ${CMAKE_INSTALL_PREFIX}/share/leonav)
set(leonav_doc ${CMAKE_INSTALL_PREFIX}/share/doc/leonav)
set(leonav_units ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)

# A text of the tree, with paths as they are here.
find_program(python3 python3 NO_CACHE REQUIRED)
set(with_installed_paths ${python3} ${source}/tools/packaging/installed_paths.py ${leonav_share} ${leonav_doc} ${leonav_etc} ${leonav_units})
function(install_text from to)
  cmake_path(GET to PARENT_PATH folder)
  file(MAKE_DIRECTORY $ENV{DESTDIR}${folder})
  execute_process(COMMAND ${with_installed_paths} INPUT_FILE ${source}/${from} OUTPUT_FILE $ENV{DESTDIR}${to} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(INSTALL ${source}/tools/packaging/leonavd.yaml DESTINATION ${leonav_etc})
install_text(config/connect.yaml ${leonav_etc}/connect.yaml)
install_text(config/serve.yaml ${leonav_etc}/serve.yaml)
install_text(README.md ${leonav_doc}/README.md)
file(GLOB_RECURSE pages RELATIVE ${source}/docs ${source}/docs/*.md)
foreach(page ${pages})
  install_text(docs/${page} ${leonav_doc}/${page})
endforeach()
foreach(unit leonavd leonav-connect leonav-serve leonav-multicast)
  configure_file(${source}/tools/packaging/systemd/${unit}.service ${build}/units/${unit}.service @ONLY)
  file(INSTALL ${build}/units/${unit}.service DESTINATION ${leonav_units})
endforeach()
file(INSTALL ${source}/tools/packaging/systemd/sysusers.conf DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/sysusers.d RENAME leonav.conf)

# The jar for lcm-spy, by the program that uses it.
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env LEONAV_SPY_DIR=${build}/spy LEONAV_SPY_ONLY_JAR=yes ${source}/tools/report/leonav-spy
  RESULT_VARIABLE failed ERROR_VARIABLE why ERROR_STRIP_TRAILING_WHITESPACE)
if(failed)
  message(STATUS "Left out: the jar of message types (${why})")
else()
  file(INSTALL ${build}/spy/leonav-types.jar DESTINATION ${CMAKE_INSTALL_PREFIX}/share/leonav/lcmtypes)
endif()

# Manuals and completions out of --help.
file(STRINGS ${source}/tools/packaging/summaries.txt summaries)
file(MAKE_DIRECTORY ${root}/share/man/man1)
foreach(program ${programs})
  set(help ${build}/manuals/${program}.txt)
  file(MAKE_DIRECTORY ${build}/manuals)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env COLUMNS=100 PYTHONDONTWRITEBYTECODE=1 ${root}/bin/${program} --help
    OUTPUT_FILE ${help} RESULT_VARIABLE failed ERROR_VARIABLE why ERROR_STRIP_TRAILING_WHITESPACE)
  if(failed)
    message(STATUS "Left out: manual and completion of ${program} (${why})")
    continue()
  endif()
  file(READ ${help} text)
  string(REGEX MATCHALL "\n  (-[a-zA-Z]( [A-Z]+)?, )?--[a-z][a-z0-9-]*" words "${text}")
  list(TRANSFORM words REPLACE ".*(--[a-z0-9-]+)$" "\\1")
  list(JOIN words " " words)
  file(WRITE ${root}/share/bash-completion/completions/${program}
       "# Made from ${program} --help.\ncomplete -o default -W '${words}' ${program}\n")
  set(summary ${summaries})
  list(FILTER summary INCLUDE REGEX "^${program}: ")
  if(NOT summary)
    message(FATAL_ERROR "tools/packaging/summaries.txt: no line of ${program}, the summary of its manual; add one")
  endif()
  string(REPLACE "${program}: " "" summary "${summary}")
  set(page ${root}/share/man/man1/${program}.1)
  execute_process(
    COMMAND ${with_installed_paths}
    COMMAND ${python3} ${source}/tools/packaging/manual.py ${program} ${summary} ${version}
    INPUT_FILE ${help} OUTPUT_FILE ${page} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9nf ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# The manual that comes before them lists them.
list(TRANSFORM summaries REPLACE "([^:]+): (.*)" ".TP\n.BR \\1 (1)\n\\2")
list(JOIN summaries "\n" leonav_programs)
configure_file(${source}/tools/packaging/leonav.7 ${root}/share/man/man7/leonav.7 @ONLY)
execute_process(COMMAND gzip -9nf ${root}/share/man/man7/leonav.7 COMMAND_ERROR_IS_FATAL ANY)
