#!/usr/bin/env bash
# How ./aabblab builds, with a CMake that is not one: a checkout that was copied or moved, what it says where there is no
# terminal, and what is left when it is killed.
set -euo pipefail

root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
# shellcheck source=tests/expectations.bash
. "$root/tests/expectations.bash"
# shellcheck source=tests/script/checkout.bash
. "$root/tests/script/checkout.bash"

# Everything is there. What is configured at a place prints that place, however often it is built, as with CMake.
printf 'ID=other\n' >os-release
printf '#!/bin/sh\necho 19.1\n' | program clang++-19
for tool in clang-scan-deps ninja gnuplot; do printf '#!/bin/sh\n' | program "$tool"; done
program cmake <<'SH'
#!/bin/sh
case $1 in
--version) echo cmake version 3.31.0 ;;
--fresh)
    build=$5/build/$3
    printf 'CMAKE_CACHEFILE_DIR:INTERNAL=%s\nCMAKE_HOME_DIRECTORY:INTERNAL=%s\n' "$build" "$5" >"$build/CMakeCache.txt"
    printf '#!/bin/sh\necho "the program of %s"\n' "$5" >"$build/build.ninja"
    ;;
--build)
    echo '[1/2] Building'
    [ ! -e "$WORK/slow" ] || exec 3>"$WORK/at_work"
    while [ -e "$WORK/slow" ]; do sleep 0.1; done
    cp "$2/build.ninja" "$2/aabblab"
    chmod +x "$2/aabblab"
    ;;
esac
SH
export PATH=$work/bin WORK=$work

expect 'a build' 0 "^the program of $work/checkout$" checkout/aabblab list
expect 'another' 0 "^the program of $work/checkout$" checkout/aabblab list
holds 'nothing is said of it' test -z "$(checkout/aabblab list 2>&1 >/dev/null)"
ln -s checkout link
holds 'nor by another name' test -z "$(link/aabblab list 2>&1 >/dev/null)"

cp -r checkout copy
touch copy/build/release/stale
expect 'a copy says what it does' 0 "^aabblab: build/release belongs to $work/checkout; it is emptied and configured for $work/copy$" \
    copy/aabblab list
expect 'and is built from its own sources' 0 "^the program of $work/copy$" copy/aabblab list
holds 'nothing of the other place is left' test ! -e copy/build/release/stale
holds 'the other place is as it was' grep -q "echo \"the program of $work/checkout\"" checkout/build/release/aabblab
mv copy moved
expect 'a checkout that was moved' 0 "^the program of $work/moved$" moved/aabblab list

# Where there is no terminal. Each of the readers ends when nobody is left who writes: who speaks, and who builds.
mkfifo said at_work
start() {
    touch slow
    rm -f heard
    cat said >heard &
    listener=$!
    cat at_work &
    watcher=$!
    # With a group of its own, because an interrupt is kept from what merely runs in the background.
    set -m
    BASH_ENV=$work/quick checkout/aabblab list >out 2>said &
    script=$!
    set +m
    holds 'it says how far it is' appears '^aabblab: building, 1 of 2 after [0-9]+ s$' heard
}
# holds_ended WHAT READER
holds_ended() {
    for _ in {1..600}; do
        kill -0 "$2" 2>/dev/null || return 0
        sleep 0.1
    done
    kill "$2"
    holds "$1" false
}
start
rm slow
holds 'it ends as ever' wait "$script"
holds 'with the program' grep -q 'the program of' out
holds_ended 'it says no more' "$listener"

for signal in TERM INT HUP; do
    start
    kill -s "$signal" "$script"
    status=0
    wait "$script" || status=$?
    holds "$signal ends it" test "$status" = 130
    holds_ended "$signal silences it" "$listener"
    holds_ended "$signal ends the build" "$watcher"
done

start
kill -s KILL "$script"
holds_ended 'nobody speaks for one that was killed' "$listener"
rm slow
holds_ended 'what it began ends' "$watcher"

exit $((failures > 0))
