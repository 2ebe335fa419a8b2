# Plain // comments as doxygen reads them. The head of a file describes the file.
FNR == 1 && /^\/\// { print "/// @file"; head = 1 }
head && !/^\/\// { head = 0 }
{
    line = $0
    if (match(line, /\/\//)) {
        before = substr(line, 1, RSTART - 1)
        words = substr(line, RSTART + 2)
        gsub(/[\\@<>&#%]/, "\\\\&", words) # not commands of doxygen
        line = before (before ~ /[^ \t]/ ? "///<" : "///") words
    }
    print line
}
