// json_headers.cpp - nothing: the target of this file is its precompiled header (CMakeLists.txt).
