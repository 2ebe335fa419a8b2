# cmake -DNODE= -DNPM= -DSOURCE= -DWORK= -DTRACTION= -DROOT= [-DBENCH=ON] -P replay_browser_test.cmake: drives, their pages, and a look at
# them. BENCH: pictures a second and the page's size instead, of a log of 120 s.
include(${SOURCE}/browser_packages.cmake)
if(SKIPPED)
  return()
endif()
set(pages ${WORK}/drives)
file(MAKE_DIRECTORY ${pages})

# drive(name scenario): a log, its truth, its page
function(drive name scenario)
  run_or_fail("no drive" ${TRACTION} simulate ${ROOT}/scenarios/${scenario}.toml --out ${pages}/${name}.csv --truth ${pages}/${name}.truth.csv)
  run_or_fail("no page" ${TRACTION} report ${pages}/${name}.csv --truth ${pages}/${name}.truth.csv --out ${pages}/${name}.html)
endfunction()

if(BENCH)
  drive(drive_long identification)
  run_or_fail("the drive is drawn too slowly, or its page is too large" ${NODE} replay_bench.mjs ${CHROMIUM} ${pages}/drive_long.html)
  return()
endif()
drive(drive_demo demo_sand)
drive(drive_rough rough_ground)
drive(drive_step step)
run_or_fail("no page" ${TRACTION} report ${pages}/drive_demo.csv --out ${pages}/drive_camera.html)
set(model ${ROOT}/models/rover_sand.toml)
run_or_fail("no drive" ${TRACTION} simulate ${ROOT}/scenarios/sweep_sand.toml --out ${pages}/sweep.csv)
run_or_fail("no comparison" ${TRACTION} compare --model ${model} --log ${pages}/sweep.csv --report ${pages}/lab.html)
# the same log blind: its camera's columns get names that mean nothing
file(READ ${pages}/sweep.csv text)
string(REPLACE "camera.x_m,camera.y_m,camera.yaw_rad" "spare.a,spare.b,spare.c" text "${text}")
file(WRITE ${pages}/blind.csv "${text}")
run_or_fail("no comparison" ${TRACTION} compare --model ${model} --log ${pages}/blind.csv --report ${pages}/lab_blind.html)
run_or_fail("a claim about the drive's page does not hold" ${NODE} replay_browser_test.mjs ${CHROMIUM} ${pages} ${WORK}/shots)
