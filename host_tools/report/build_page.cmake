# cmake -DNPM= -DNODE= -DWEB= -DWORK= [-DPAGE=] [-DAGAINST=] -P build_page.cmake: builds the page in WORK, a copy of WEB; writes it to
# PAGE, or compares it byte for byte with AGAINST, the committed one.
cmake_minimum_required(VERSION 3.25)
if(NOT NPM OR NOT NODE)
  if(AGAINST)
    message(STATUS "SKIPPED: the report page is rebuilt with node and npm, which are not in PATH (apt-get install nodejs npm)")
    return()
  endif()
  message(FATAL_ERROR "The report page is rebuilt with node and npm, which are not in PATH: install them "
                      "(Debian and Ubuntu: apt-get install nodejs npm), then configure again.")
endif()

# Runs a command in WORK; on failure shows the end of what it said and stops with one message.
function(run_or_stop advice)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    string(LENGTH "${said}" length)
    if(length GREATER 1500)
      math(EXPR from "${length} - 1500")
      string(SUBSTRING "${said}" ${from} -1 said)
    endif()
    message(FATAL_ERROR "${advice}\n${said}")
  endif()
endfunction()

# a fresh copy of the sources; the packages stay
file(MAKE_DIRECTORY ${WORK})
file(REMOVE_RECURSE ${WORK}/src ${WORK}/dist)
file(COPY ${WEB}/ DESTINATION ${WORK} PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE)

file(SHA256 ${WEB}/package-lock.json lock)
set(installed "")
if(EXISTS ${WORK}/node_modules/.traction-lock)
  file(READ ${WORK}/node_modules/.traction-lock installed)
endif()
if(NOT installed STREQUAL lock)
  run_or_stop("npm could not bring the report page's packages (vite, uplot; pinned in host_tools/report/web/package-lock.json). \
Is the npm registry reachable? Behind a proxy set https_proxy or 'npm config set registry'; then build again. npm said:"
              ${NPM} ci --no-audit --no-fund --loglevel=error)
  file(WRITE ${WORK}/node_modules/.traction-lock ${lock})
endif()
run_or_stop("Vite could not build the report page (host_tools/report/web). It said:"
            ${NODE} node_modules/vite/bin/vite.js build --logLevel warn)

if(PAGE)
  file(COPY_FILE ${WORK}/dist/index.html ${PAGE})
endif()
if(AGAINST)
  file(SHA256 ${WORK}/dist/index.html built)
  file(SHA256 ${AGAINST} committed)
  if(NOT built STREQUAL committed)
    message(FATAL_ERROR "${AGAINST} is not what host_tools/report/web builds now: run  ninja -C build/host report_page  and commit it")
  endif()
  message(STATUS "the committed page is what its sources build, byte for byte")
endif()
