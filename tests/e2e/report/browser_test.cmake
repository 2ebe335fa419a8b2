# cmake -DNODE= -DNPM= -DSOURCE= -DWORK= -DPAGES= -DTRACTION= -DROOT= -P browser_test.cmake: makes sample results and real ones, their
# pages, and looks at them.
include(${SOURCE}/browser_packages.cmake)
if(SKIPPED)
  return()
endif()
run_or_fail("the sample results could not be made" ${NODE} sample.mjs ${WORK}/pages)
run_or_fail("no drive" ${TRACTION} simulate ${ROOT}/scenarios/sweep_sand.toml --out ${WORK}/sweep.csv)
run_or_fail("no comparison" ${TRACTION} compare --model ${ROOT}/models/rover_sand.toml --log ${WORK}/sweep.csv --json ${WORK}/pages/real_compare.json)
run_or_fail("no check" ${TRACTION} check ${WORK}/sweep.csv --json ${WORK}/pages/real_check.json)
run_or_fail("no speed" ${TRACTION} speed ${WORK}/sweep.csv --out ${WORK}/speed.csv --report ${WORK}/pages/real_speed.html)
run_or_fail("no history" ${TRACTION} history --model ${ROOT}/models/rover_sand.toml --json ${WORK}/pages/real_history.json)
run_or_fail("the pages could not be written" ${PAGES} ${WORK}/pages)
run_or_fail("a claim about the page does not hold" ${NODE} browser_test.mjs ${CHROMIUM} ${WORK}/pages ${WORK}/shots)
