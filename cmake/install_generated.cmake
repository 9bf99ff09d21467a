# Run by `cmake --install`: what depends on the prefix (links, units, configuration) and what the installed programs
# make (manuals, completions). In: source, build, version, programs, scripts (paths below source).
set(root $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
set(share ${root}/share/leonav)

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
file(INSTALL ${source}/packaging/leonavd.yaml ${source}/config/connect.yaml ${source}/config/serve.yaml
     DESTINATION $ENV{DESTDIR}${leonav_etc})
foreach(unit leonavd leonav-connect leonav-serve leonav-multicast)
  configure_file(${source}/packaging/systemd/${unit}.service ${build}/units/${unit}.service @ONLY)
  file(INSTALL ${build}/units/${unit}.service DESTINATION ${root}/lib/systemd/system)
endforeach()
file(INSTALL ${source}/packaging/systemd/sysusers.conf DESTINATION ${root}/lib/sysusers.d RENAME leonav.conf)

# The jar for lcm-spy, by the program that uses it.
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env LEONAV_SPY_DIR=${build}/spy LEONAV_SPY_ONLY_JAR=yes ${source}/tools/report/leonav-spy
  RESULT_VARIABLE failed ERROR_VARIABLE why ERROR_STRIP_TRAILING_WHITESPACE)
if(failed)
  message(STATUS "Left out: the jar of message types (${why})")
else()
  file(INSTALL ${build}/spy/leonav-types.jar DESTINATION ${share}/lcmtypes)
endif()

# Manuals and completions out of --help.
find_program(help2man help2man NO_CACHE)
if(NOT help2man)
  message(STATUS "Left out: manuals (no help2man; install it: apt-get install help2man)")
endif()
file(STRINGS ${source}/packaging/summaries.txt summaries)
foreach(program ${programs})
  execute_process(COMMAND ${root}/bin/${program} --help OUTPUT_VARIABLE help RESULT_VARIABLE failed ERROR_VARIABLE why)
  if(failed)
    message(STATUS "Left out: manual and completion of ${program} (${why})")
    continue()
  endif()
  string(REGEX MATCHALL "\n  (-[a-z]( [A-Z]+)?, )?--[a-z][a-z0-9-]*" words "${help}")
  list(TRANSFORM words REPLACE ".*(--[a-z0-9-]+)$" "\\1")
  list(JOIN words " " words)
  set(folder ${root}/share/bash-completion/completions)
  file(WRITE ${folder}/${program} "# Made from ${program} --help.\ncomplete -o default -W '${words}' ${program}\n")
  if(NOT help2man)
    continue()
  endif()
  set(summary ${summaries})
  list(FILTER summary INCLUDE REGEX "^${program}: ")
  if(NOT summary)
    message(FATAL_ERROR "packaging/summaries.txt: no line of ${program}, the name of its manual; add one")
  endif()
  string(REPLACE "${program}: " "" summary "${summary}")
  set(page ${root}/share/man/man1/${program}.1)
  file(MAKE_DIRECTORY ${root}/share/man/man1)
  execute_process(
    COMMAND ${help2man} --no-info --name=${summary} --manual=leonav --source=leonav\ ${version} --output=${page}
            ${root}/bin/${program}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9nf ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
