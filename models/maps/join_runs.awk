# join_runs.awk - several runs of one machine as one log: awk -f models/maps/join_runs.awk RUN.csv RUN.csv ... > JOINED.csv
#
# For CSV files of equal columns, time first. Each run begins 3 s after the last one ended: longer than any gap that the lab reads
# across (0.25 s for a wheel, 0.84 s for a camera's displacement), so that no row spans two runs.
BEGIN { FS = OFS = ","; gap_s = 3 }
FNR == 1 {
    if (NR == 1) { header = $0; print; shift_s = 0 } else shift_s = last_s + gap_s
    if ($0 != header) { print FILENAME ": other columns than the first file" > "/dev/stderr"; exit 1 }
    first = 1
    next
}
first { shift_s -= $1; first = 0 }
{ last_s = $1 + shift_s; $1 = sprintf("%.7g", last_s); print }
