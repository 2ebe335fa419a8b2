# The MIT licence asks that its notice goes with every copy: uPlot is in the page, so its whole notice is.
file(READ ${PAGE} page)
foreach(words "Copyright (c) 2022 Leon Sorokin" "Permission is hereby granted, free of charge" "permission notice shall be included in"
        "WITHOUT WARRANTY OF ANY KIND")
  string(FIND "${page}" "${words}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${PAGE} lacks a part of uPlot's licence: ${words}")
  endif()
endforeach()
