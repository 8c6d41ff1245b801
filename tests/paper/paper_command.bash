#!/usr/bin/env bash
# ./aabblab paper, with a TeX that is not one: what it refuses, what it hands to TeX, and what it leaves behind.
set -euo pipefail

root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
# shellcheck source=tests/expectations.bash
. "$root/tests/expectations.bash"

# What stands in for TeX finds every file, and wants one more run after the first.
mkdir bin
cat >bin/kpsewhich <<'TEX'
#!/usr/bin/env bash
printf '/tex/%s\n' "$@"
TEX
cat >bin/pdflatex <<'TEX'
#!/usr/bin/env bash
printf 'run\n' >>"$RUNS"
cat results/macros.tex
if grep -q broken results/macros.tex; then
    printf 'tex/sections/c1.tex:3: Package aabblab Error: the results have no C1.ratio.\n' | tee paper.log
    exit 1
fi
cat tex/paper.tex results/macros.tex >paper.pdf
if [[ -e seen ]]; then printf 'all is well\n'; else printf 'Rerun to get references right\n'; fi >paper.log
touch seen
TEX
chmod +x bin/*
export PATH=$work/bin:$PATH RUNS=$work/runs

expect 'no results at all' 2 'no results in results/reproduce; run ./aabblab reproduce first' "$root/aabblab" paper
expect 'no such folder' 2 'no results in nowhere' "$root/aabblab" paper nowhere
mkdir 'my results'
expect 'no macros' 2 'my results has no macros.tex; run ./aabblab reproduce first' "$root/aabblab" paper 'my results'
printf 'numbers\n' >'my results/macros.tex'
expect 'unknown option' 2 "no option '--put'" "$root/aabblab" paper 'my results' --put x.pdf
expect 'two folders' 2 "unexpected argument 'more'" "$root/aabblab" paper 'my results' more
expect 'no file' 2 'takes one value' "$root/aabblab" paper 'my results' --out
expect 'not a PDF' 2 'must end in .pdf' "$root/aabblab" paper 'my results' --out x.ps
expect 'a file as folder' 2 'cannot be written' "$root/aabblab" paper 'my results' --out 'my results/macros.tex/x.pdf'
expect 'a name too long' 2 'cannot be written' "$root/aabblab" paper 'my results' --out "$(printf 'x%.0s' {1..300}).pdf"
expect 'help' 0 'RESULTS_DIR' "$root/aabblab" paper --help
holds 'TeX has not run yet' test ! -e runs

expect 'a paper' 0 '^The paper is my results/paper.pdf$' "$root/aabblab" paper 'my results'
holds 'it has the results' grep -q numbers 'my results/paper.pdf'
holds 'two runs' test "$(wc -l <runs)" = 2
holds 'no log is left' test "$(ls 'my results')" = $'macros.tex\npaper.pdf'
expect 'elsewhere' 0 'The paper is deep/er/x.pdf' "$root/aabblab" paper 'my results/' --out deep/er/x.pdf
holds 'it is there' test -s deep/er/x.pdf

mkdir -p results/reproduce-quick
printf 'quick\n' >results/reproduce-quick/macros.tex
expect 'quick results, where only they are there' 0 'The paper is results/reproduce-quick/paper.pdf' "$root/aabblab" paper
mkdir results/reproduce
printf 'broken\n' >results/reproduce/macros.tex
expect 'a missing number' 2 'the results have no C1.ratio\); the whole log is results/reproduce/paper.pdf.log' "$root/aabblab" paper
holds 'the log is kept' grep -q C1.ratio results/reproduce/paper.pdf.log

exit $((failures > 0))
