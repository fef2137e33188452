# SPDX-License-Identifier: Apache-2.0
# Core, native library and simulator for 64-bit Windows, on Debian: apt-get install gcc-mingw-w64-x86-64
#     cmake -S . -B build/windows -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/mingw-w64.cmake -DLW_TOOL_ONLY=ON
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
find_program(LW_WINE NAMES wine64 wine) # runs the tests; Debian: apt-get install wine64
if(LW_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${LW_WINE})
endif()
