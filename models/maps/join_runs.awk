# join_runs.awk - several runs of one machine as one log: awk -v counts=7,8,9 -f models/maps/join_runs.awk RUN.csv RUN.csv ... > JOINED.csv
#
# For CSV files of equal columns, time first. Each run begins 3 s after the last one ended: longer than any gap that the lab reads
# across (0.25 s for a wheel, 0.84 s for a camera's displacement), so that no row spans two runs. `counts`: columns of counters, which
# go on from where the last run left them: a reset would be read as a wheel that spins back in those 3 s.
BEGIN { FS = OFS = ","; gap_s = 3; n = split(counts, column, ",") }
FNR == 1 {
    if (NR == 1) { header = $0; print } else base_s = last_s + gap_s
    if ($0 != header) { print FILENAME ": other columns than the first file" > "/dev/stderr"; exit 1 }
    first = 1
    next
}
first {
    start_s = $1
    for (i = 1; i <= n; i++) shift[i] = last[i] - $column[i]
    first = 0
}
{
    last_s = base_s + $1 - start_s
    $1 = sprintf("%.7g", last_s)
    for (i = 1; i <= n; i++) $column[i] = last[i] = sprintf("%.9g", $column[i] + shift[i])
    print
}
