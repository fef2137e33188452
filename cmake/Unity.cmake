# Provides the target unity::framework (the Unity C test framework). UNITY_ROOT, a cache or environment variable, names
# a folder with unity.c; without it, what `./dev` has fetched into build/unity or an installed Unity is used, and at last
# Unity is cloned from GitHub.
set(UNITY_ROOT "" CACHE PATH "Folder with the source of the Unity test framework")
find_path(UNITY_SOURCE_DIR unity.c HINTS ${UNITY_ROOT} ENV UNITY_ROOT PATHS ${PROJECT_SOURCE_DIR}/build/unity
  PATH_SUFFIXES src NO_DEFAULT_PATH NO_CACHE)

if(NOT UNITY_SOURCE_DIR)
  find_package(unity CONFIG QUIET)
  if(TARGET unity::framework)
    return()
  endif()

  find_path(UNITY_INCLUDE_DIR unity.h PATH_SUFFIXES unity)
  find_library(UNITY_LIBRARY unity)
  if(UNITY_INCLUDE_DIR AND UNITY_LIBRARY)
    add_library(unity::framework UNKNOWN IMPORTED)
    set_target_properties(unity::framework PROPERTIES
      IMPORTED_LOCATION ${UNITY_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${UNITY_INCLUDE_DIR})
    return()
  endif()

  include(FetchContent)
  FetchContent_Declare(unity
    GIT_REPOSITORY https://github.com/ThrowTheSwitch/Unity.git GIT_TAG v2.6.0 GIT_SHALLOW ON)
  FetchContent_MakeAvailable(unity)
  target_compile_definitions(unity PUBLIC UNITY_INCLUDE_DOUBLE=)
  return()
endif()

message(STATUS "Unity: ${UNITY_SOURCE_DIR}")
add_library(unity STATIC ${UNITY_SOURCE_DIR}/unity.c)
target_include_directories(unity SYSTEM PUBLIC ${UNITY_SOURCE_DIR})
target_compile_definitions(unity PUBLIC UNITY_INCLUDE_DOUBLE=)
add_library(unity::framework ALIAS unity)
