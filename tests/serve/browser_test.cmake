# cmake -DNODE= -DNPM= -DSOURCE= -DPACKAGES= -DWORK= -DTRACTION= [-DTRACTIOND=] -P browser_test.cmake: clicks through `traction serve` in a
# real Chromium; with TRACTIOND a rover is watched too. PACKAGES: the folder of the report's tests, whose packages these are.
include(${PACKAGES}/browser_packages.cmake)
if(SKIPPED)
  return()
endif()
run_or_fail("a claim about the live page does not hold" ${NODE} browser_test.mjs ${CHROMIUM} ${TRACTION} ${WORK}/folder ${WORK}/shots)
if(TRACTIOND)
  run_or_fail("a claim about a rover on the live page does not hold" ${NODE} rover_test.mjs ${CHROMIUM} ${TRACTION} ${TRACTIOND} ${WORK}/rover ${WORK}/shots)
else()
  message("no rover was watched: there is no supervision link in this build (pymavlink)")
endif()
