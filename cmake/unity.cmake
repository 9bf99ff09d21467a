# Several sources of a target compiled as one: most of a build's time goes into headers and templates, which are
# then parsed once for all of them. A cold build is quicker; after a change to one source its
# neighbours are compiled as well, for which -DLEONAV_UNITY=OFF is there. With gcc, and for fuzzing; so an ordinary build
# with clang still finds a source that does not include what it uses. Names of one target's sources must differ, those
# in unnamed namespaces too: share what is the same thing, and name what is not for what it is.
option(LEONAV_UNITY "Compile several sources of a target as one" ON)
if(LEONAV_UNITY AND (CMAKE_CXX_COMPILER_ID STREQUAL GNU OR LEONAV_FUZZ))
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 32)
  # gcc takes a source that another includes for a header, whose classes should not use what is unnamed.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
