// test_headers.cpp - nothing: the targets of this file are the precompiled headers of the tests (CMakeLists.txt); gtest brings main.
