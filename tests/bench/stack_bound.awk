# stack_bound - the deepest stack that any path through a program's call graph can need below one function, from its disassembly.
# usage: arm-linux-gnueabi-objdump -d --no-show-raw-insn PROGRAM | awk -v root=control_step -f stack_bound.awk
# A function's frame is what it pushes and what it subtracts from sp; a branch to another function's start counts as a call. It stops with a message at
# what it cannot bound: recursion, a call through a pointer, a frame whose size is not a constant.
/^[0-9a-f]+ <.*>:$/ { name = $2; gsub(/[<>:]/, "", name); next }
name == "" { next }
{ op = $2; text = $0; sub(/;.*/, "", text); sub(/@.*/, "", text) }
op ~ /^(push|stmdb|stmfd)/ && (op ~ /^push/ || $3 ~ /^sp!/) {
  list = text; sub(/.*\{/, "", list); sub(/\}.*/, "", list); n = split(list, part, ",")
  for (i = 1; i <= n; i++) frame[name] += part[i] ~ /-/ ? 4 * range(part[i]) : 4
}
op ~ /^str/ && text ~ /\[sp, #-[0-9]+\]!/ { bytes = text; sub(/.*#-/, "", bytes); sub(/\].*/, "", bytes); frame[name] += bytes }
op ~ /^sub/ && $3 == "sp," { if ($4 == "sp," && $5 ~ /^#/) frame[name] += substr($5, 2); else if ($4 ~ /^#/) frame[name] += substr($4, 2); else unknown[name] = 1 }
op ~ /^b(l|lx)?(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)?$/ {
  if (op ~ /^blx/ && $3 !~ /^[0-9a-f]+$/) pointer[name] = 1
  else if ($4 ~ /^<[^+>]+>$/) { to = $4; gsub(/[<>]/, "", to); if (to != name) calls[name] = calls[name] " " to }
}
op ~ /^bx/ && $3 != "lr" { pointer[name] = 1 }
function range(text, ends, r) { split(text, ends, "-"); for (r = 1; r <= 2; r++) { gsub(/[ r]/, "", ends[r]) } return ends[2] - ends[1] + 1 }
function depth(f, list, n, i, most, below) {
  if (f in known) return known[f]
  if (f in open) { print "stack_bound: " f " calls itself" > "/dev/stderr"; exit_code = 1; return 0 }
  if (f in pointer || f in unknown) { print "stack_bound: " f (f in pointer ? " calls through a pointer" : " has a frame of unknown size") > "/dev/stderr"; exit_code = 1 }
  open[f] = 1
  n = split(calls[f], list, " ")
  for (i = 1; i <= n; i++) { below = depth(list[i]); if (below > most) { most = below; next_of[f] = list[i] } }
  delete open[f]
  return known[f] = frame[f] + most
}
END {
  if (!(root in frame)) { print "stack_bound: no function " root > "/dev/stderr"; exit 1 }
  bytes = depth(root)
  for (f = root; f != ""; f = next_of[f]) path = path (path == "" ? "" : " > ") f " " frame[f] + 0
  print bytes " bytes: " path
  exit exit_code
}
