#!/bin/bash
# compare.bash COMMIT: compares the instructions of eight frames, as callgrind counts them, with those of an earlier commit,
# in every way that both have: what came since costs nothing where it is left out. Exit status 1 if a number differs.
set -euo pipefail

checkout=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'git -C "$checkout" worktree remove --force "$work/checkout"; rm -rf "$work"' EXIT
git -C "$checkout" worktree add --quiet --detach "$work/checkout" "$1"

# build CHECKOUT FOLDER
build() {
    if ! { cmake -S "$1/tests/zero_cost" -B "$2" -G Ninja -DCHECKOUT="$1" -DCMAKE_CXX_COMPILER=clang++-19 &&
        cmake --build "$2"; } >"$work/log" 2>&1; then
        cat "$work/log"
        exit 2
    fi
}

# count FOLDER WAY OBJECTS: instructions; nothing if it has no such way. Those of the C library are left out: how many it takes
# to copy or to clear a block depends on where malloc puts it.
count() {
    valgrind --tool=callgrind --callgrind-out-file="$work/counts" '--toggle-collect=*measured_frames*' \
        "$1/stage_costs" "$2" "$3" >/dev/null 2>&1
    callgrind_annotate --threshold=100 "$work/counts" 2>/dev/null |
        awk '/\[.*stage_costs\]$/ { gsub(",", "", $1); sum += $1 } END { if (sum) print sum }'
}

build "$work/checkout" "$work/before"
build "$checkout" "$work/now"
status=0
for way in by_hand uncounted composed counted cut prepared filtered columns_by_hand columns counted_columns prepared_columns; do
    for objects in 2000 4000; do
        before=$(count "$work/before" $way $objects)
        now=$(count "$work/now" $way $objects)
        [ -n "$before" ] || continue
        verdict=equal
        [ "$now" = "$before" ] || { verdict=differs; status=1; }
        printf '%-16s %5d boxes: %10d instructions, before %10d: %s\n' $way $objects "$now" "$before" $verdict
    done
done
exit $status
