#!/usr/bin/env bash
# How ./aabblab builds, with a CMake that is not one: what it answers before, when it builds and when it need not, a checkout
# that was copied or moved, what it says where there is no terminal, and what is left when it is killed.
set -euo pipefail

root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
# shellcheck source=tests/expectations.bash
. "$root/tests/expectations.bash"
# shellcheck source=tests/script/checkout.bash
. "$root/tests/script/checkout.bash"

# Everything is there. What is configured at a place prints that place, however often it is built, as with CMake.
printf 'ID=other\n' >os-release
printf '#!/bin/sh\necho 19.1\n' | program clang++-19
for tool in clang-scan-deps ninja; do printf '#!/bin/sh\n' | program "$tool"; done
program cmake <<'SH'
#!/bin/sh
echo "$1" >>"$WORK/calls"
case $1 in
--version) echo cmake version 3.31.0 ;;
--fresh)
    build=$5/build/$3
    printf 'CMAKE_CACHEFILE_DIR:INTERNAL=%s\nCMAKE_HOME_DIRECTORY:INTERNAL=%s\n' "$build" "$5" >"$build/CMakeCache.txt"
    printf '#!/bin/sh\necho "the program of %s"\n' "$5" >"$build/build.ninja"
    ;;
--build)
    echo '[1/2] Building'
    [ ! -e "$WORK/slow" ] || { exec 3>"$WORK/at_work" && echo >&3; }
    while [ -e "$WORK/slow" ]; do sleep 0.1; done
    [ ! -e "$WORK/broken" ] || exit 1
    cp "$2/build.ninja" "$2/aabblab"
    chmod +x "$2/aabblab"
    ;;
esac
SH
system_path=$PATH
export PATH=$work/bin WORK=$work

# ---- Where nothing is built -------------------------------------------------------------------------------------------

expect 'the commands' 0 '^  reproduce  +Reproduce every table, figure and claim' checkout/aabblab --help
holds 'the same without a word' test "$(checkout/aabblab)" = "$(checkout/aabblab -h)"
expect 'the options of a command' 0 '^Usage: aabblab run ' checkout/aabblab run --help
expect 'of what it is given' 0 '^Usage: aabblab run ' checkout/aabblab run config.toml -h
expect 'of a command within a command' 0 '^Usage: aabblab validate stiff ' checkout/aabblab validate stiff --help
expect 'strategies' 0 '^  axial_cut ' checkout/aabblab list
for heading in engines library_tests integrators; do
    expect "nobody knows which $heading" 0 "^$heading.*availability unknown" checkout/aabblab list
done
holds 'nothing was built for it' test ! -e checkout/build
holds 'nor was CMake asked' test ! -e calls

# ---- What is built, and when ------------------------------------------------------------------------------------------

expect 'a build' 0 "^the program of $work/checkout$" checkout/aabblab pairs
expect 'another' 0 "^the program of $work/checkout$" checkout/aabblab pairs
holds 'nothing is said of it' test -z "$(checkout/aabblab pairs 2>&1 >/dev/null)"
expect 'the program itself tells its commands' 0 "^the program of $work/checkout$" checkout/aabblab --help

# builds WHETHER WHAT [COMMAND…]: does a call, with this done before, build?
builds() {
    local whether=$1 what=$2
    shift 2
    : >calls
    "$@" >/dev/null
    # What waits for the lock that is held here is ended.
    expect "$what" 0 "^the program of $work/checkout$" env "${settings[@]}" timeout 60 checkout/aabblab pairs
    holds "$what: built? $whether" test "$whether" = "$(if [[ -s calls ]]; then echo yes; else echo no; fi)"
}
settings=()
source=checkout/validation/engines/engines.cpp
builds no 'nothing has changed' true
exec {held}>>checkout/build/.lock
flock "$held"
builds no 'it waits for nobody' true
exec {held}>&-
builds yes 'a new file' touch "$source"
builds no 'that is built' true
builds yes 'a changed file' touch "$source"
builds yes 'a file that has gone' rm "$source"
builds yes 'a folder that has gone' rm -r checkout/strategies
builds yes 'as long as it is gone' true
mkdir checkout/strategies
builds yes 'a folder that is back' true
builds no 'it is all there' true
builds yes 'presets' touch checkout/CMakePresets.json
holds 'that CMake is told' grep -q '^--preset' calls
builds yes 'packages' touch packages
holds 'which CMake looks for' grep -q '^--preset' calls
builds yes 'a build of another configuration' touch checkout/build/release/build.ninja
builds yes 'a program that has gone' rm checkout/build/release/aabblab
settings=(AABBLAB_INSTALL=all)
builds yes 'other packages are wanted' true
builds no 'they were looked for' true
settings=()
builds no 'and the others too' true
touch "$source" broken
expect 'a build that fails' 2 'the build failed' checkout/aabblab pairs
rm broken
builds yes 'it is tried again' true
touch slow
checkout/aabblab pairs >/dev/null & # nothing to build
holds 'a call with nothing to build does not wait for one' wait $!
touch "$source"
checkout/aabblab pairs >/dev/null 2>&1 &
script=$!
holds 'a build is under way' appears '' at_work
touch "$source"
rm slow
wait "$script"
rm at_work
builds yes 'what changed meanwhile' true
rm packages
builds yes 'nobody knows what is installed' touch "$source"
builds yes 'and never will' true
touch packages
builds yes 'it is known' true
builds no 'and nothing has changed' true

# The program knows its commit, and whether the sources differ from it.
git=$(PATH=$system_path type -P git) || git=''
if [[ $git ]]; then
    ln -s "$git" bin/
    export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
    in_git() { git -C checkout -c user.name=tests -c user.email=tests@example.org "$@" >/dev/null 2>&1; }
    echo /build/ >checkout/.gitignore
    in_git init --initial-branch=first
    in_git add .
    in_git commit --message=first
    builds yes 'a commit' touch "$source"
    builds no 'the same commit' true
    builds yes 'another commit of the same files' in_git commit --allow-empty --message=second
    builds yes 'an amended commit' in_git commit --allow-empty --amend --message=third
    builds yes 'another branch at the same commit' in_git checkout -b second
    builds yes 'a detached head' in_git checkout --detach HEAD
    builds yes 'a commit on no branch' in_git commit --allow-empty --message=fourth
    builds yes 'a file that is no longer part of it' in_git rm --cached CMakePresets.json
    builds yes 'packed references' in_git pack-refs --all
    builds yes 'a file at the root that is no source' touch checkout/.gitignore
    builds no 'what somebody leaves there' touch checkout/scene.aabbs
    in_git checkout first
    builds yes 'a branch whose reference is packed' in_git commit --allow-empty --message=fifth
    builds no 'it is built' true
fi

ln -s checkout link
holds 'nor by another name' test -z "$(link/aabblab pairs 2>&1 >/dev/null)"

cp -r checkout copy
touch copy/build/release/stale
expect 'a copy says what it does' 0 "^aabblab: build/release belongs to $work/checkout; it is emptied and configured for $work/copy$" \
    copy/aabblab pairs
expect 'and is built from its own sources' 0 "^the program of $work/copy$" copy/aabblab pairs
holds 'nothing of the other place is left' test ! -e copy/build/release/stale
holds 'the other place is as it was' grep -q "echo \"the program of $work/checkout\"" checkout/build/release/aabblab
mv copy moved
expect 'a checkout that was moved' 0 "^the program of $work/moved$" moved/aabblab pairs

# Where there is no terminal. Each of the readers ends when nobody is left who writes: who speaks, and who builds.
mkfifo said at_work
start() {
    touch packages
    touch slow
    rm -f heard
    cat said >heard &
    listener=$!
    cat at_work >/dev/null &
    watcher=$!
    # With a group of its own, because an interrupt is kept from what merely runs in the background.
    set -m
    BASH_ENV=$work/quick checkout/aabblab pairs >out 2>said &
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
