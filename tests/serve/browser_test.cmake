# cmake -DNODE= -DNPM= -DSOURCE= -DPACKAGES= -DWORK= -DTRACTION= [-DTRACTIOND=] [-DLONG=ON] -P browser_test.cmake: clicks through
# `traction serve` in a real Chromium; with TRACTIOND a rover is watched too. LONG: a log of 1000 s instead. PACKAGES: the folder of the
# report's tests, whose packages these are.
include(${PACKAGES}/browser_packages.cmake)
if(SKIPPED)
  return()
endif()
if(LONG)
  run_or_fail("a long log is shown too slowly, or takes too much memory" ${NODE} long_test.mjs ${CHROMIUM} ${TRACTION} ${WORK}/long ${WORK}/shots)
  return()
endif()
run_or_fail("a claim about the live page does not hold" ${NODE} browser_test.mjs ${CHROMIUM} ${TRACTION} ${WORK}/folder ${WORK}/shots)
if(TRACTIOND)
  run_or_fail("a claim about a rover on the live page does not hold" ${NODE} rover_test.mjs ${CHROMIUM} ${TRACTION} ${TRACTIOND} ${WORK}/rover ${WORK}/shots)
else()
  message("no rover was watched: there is no supervision link in this build (pymavlink)")
endif()
