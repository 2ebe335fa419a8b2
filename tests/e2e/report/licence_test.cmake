# cmake -DPAGE= [-DOWNER=] -P licence_test.cmake: the MIT licence asks that its notice goes with every copy: uPlot is in the page, three.js in
# the code of its scene, so their whole notices are.
if(NOT OWNER)
  set(OWNER "Copyright (c) 2022 Leon Sorokin")
endif()
file(READ ${PAGE} page)
foreach(words "${OWNER}" "Permission is hereby granted, free of charge" "permission notice shall be included in"
        "WITHOUT WARRANTY OF ANY KIND")
  string(FIND "${page}" "${words}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${PAGE} lacks a part of its library's licence: ${words}")
  endif()
endforeach()
