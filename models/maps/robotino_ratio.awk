# robotino_ratio.awk - camera speed over wheel speed of a straight Robotino run, by its two ends: awk -f models/maps/robotino_ratio.awk RUN.csv ...
# Wheel speed with r = 0.040 m and 2000 ticks a turn, gear 16; from 3 s to the end. Then the mean
# currents [A] of the three wheels, the ticks a turn that the speed column makes of the positions, and the share of repeated camera frames.
BEGIN { FS = ","; metre = 0.040 * 2 * 3.14159265 / 2000 / 16 }
FNR == 1 { if (NR > 1) tell(); started = 0; name = FILENAME; next }
!started && $1 > 3 { started = 1; for (i = 7; i <= 9; i++) p[i] = $i; x = $16; y = $17; n = c1 = c2 = c3 = v = same = 0; t = $1 }
started { for (i = 7; i <= 9; i++) q[i] = $i; xe = $16; ye = $17; n++; c1 += $13; c2 += $14; c3 += $15; te = $1
    for (i = 10; i <= 12; i++) v += $i < 0 ? -$i : $i
    frame = $16 " " $17 " " $18; same += frame == last; last = frame }
function tell(  a, b, c, vx, vy, i, turned) {
    for (i = 7; i <= 9; i++) turned += q[i] < p[i] ? p[i] - q[i] : q[i] - p[i]
    a = (q[7] - p[7]) * metre; b = (q[8] - p[8]) * metre; c = (q[9] - p[9]) * metre
    vx = (c - a) / sqrt(3); vy = (a + c - 2 * b) / 3 # least squares of w_i r = -sin d vx + cos d vy + R yaw, d = 60, 180, 300 deg
    sub(/.*\//, "", name)
    printf "%-38s ratio %.4f  currents %.2f %.2f %.2f  ticks %.0f  repeated %.2f\n", name, sqrt((xe - x) ^ 2 + (ye - y) ^ 2) / sqrt(vx ^ 2 + vy ^ 2), c1 / n, c2 / n, c3 / n, turned / (v / n * (te - t)) * 2 * 3.14159265, same / n
}
END { tell() }
