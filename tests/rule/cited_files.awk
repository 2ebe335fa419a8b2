# cited_files.awk - every file that a document or a comment cites stands in the repository. Input: first the list of the repository's files,
# then the files to read. A citation is a name that ends in .md, .h, .c, .cpp, .cmake, .sh, .py, .ts, .awk, or in .toml under scenarios/ or models/;
# it is a path from the root, from the citing file's folder, or the end of one ("fit/problem.h", "problem.h"); {a,b} is expanded, what holds *
# or < is a pattern and not looked for. A name in capitals before a section's number cites a document that has no file. Exit 1 with one line per citation of nothing.
function known(path, folder) {
    gsub(/\/\.\//, "/", path)
    if (path in exists || (folder "/" path) in exists) return 1
    while (sub(/^\.\.\//, "", path)) sub(/\/?[^\/]*$/, "", folder)
    return path in exists || (folder "/" path) in exists
}
function cited(name,    open, close_, parts, n, i, head, tail) { # 1 where all that the name expands to is there
    if (name ~ /[*<>]/) return 1
    open = index(name, "{")
    if (open > 0) {
        close_ = index(name, "}")
        head = substr(name, 1, open - 1); tail = substr(name, close_ + 1)
        n = split(substr(name, open + 1, close_ - open - 1), parts, ",")
        for (i = 1; i <= n; i++)
            if (!known(head parts[i] tail, folder)) return 0
        return 1
    }
    return known(name, folder)
}
function offence(what) { printf "%s:%d: cites %s, which is not in the repository\n", shown, FNR, what; broken = 1 }
BEGIN {
    elsewhere["page.cpp"]   # made in the build folder
    elsewhere["kiss_fft.c"] # of the system's source package
}
FILENAME == list {
    path = $0
    exists[path] = 1
    while (sub(/^[^\/]*\//, "", path)) exists[path] = 1
    next
}
FNR == 1 {
    shown = substr(FILENAME, length(root) + 2)
    folder = shown
    if (!sub(/\/[^\/]*$/, "", folder)) folder = ""
    is_document = FILENAME ~ /\.md$/
    hash_comment = FILENAME ~ /\.(toml|py|sh|cmake|txt|awk)$/ || FILENAME ~ /\/traction$/
    counted++
}
{
    text = $0
    gsub(/https?:\/\/[^ )>"]*/, "", text)
    if (!is_document) {
        at = hash_comment ? match(text, /(^|[ \t])#/) : match(text, /\/\//)
        if (at == 0) next
        text = substr(text, at + RLENGTH)
    }
    if (match(text, /(^|[^A-Za-z])[A-Z][A-Z]+ (sections?|table) [0-9I]/)) {
        name = substr(text, RSTART, RLENGTH)
        sub(/^[^A-Z]/, "", name)
        offence("\"" name "\"")
    }
    while (match(text, /[A-Za-z0-9_.\/{},*<>-]*[A-Za-z0-9_*}>]\.(md|h|cpp|c|cmake|sh|py|ts|awk|toml)([^A-Za-z0-9_]|$)/)) {
        name = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        sub(/[^A-Za-z0-9_]$/, "", name)
        sub(/^[,.]*\/?/, "", name) # "..." and separators before a name; ../ is of no use from the root
        if (name ~ /\.toml$/ && name !~ /^(scenarios|models)\//) continue # a name in an example
        if (name ~ /^shared\//) continue                                    # said to be outside, where it stands
        if (name in elsewhere) continue
        if (!cited(name)) offence(name)
    }
}
END {
    if (counted == 0) { print "no file was read: the rule was not checked"; exit 3 }
    if (broken) exit 1
    printf "citations hold in %d files\n", counted
}
