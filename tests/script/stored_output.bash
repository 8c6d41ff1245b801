#!/usr/bin/env bash
# stored_output.bash PROGRAM: is what experiments/stored_output/ says the program prints what it prints? ./aabblab answers
# from there where nothing is built. stored_output.bash PROGRAM --write stores it anew.
set -euo pipefail

program=$(readlink -f -- "$1")
stored=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")/experiments/stored_output
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
printed=$work/stored_output
# As it is where there is no terminal, however wide that of the caller is.
unset COLUMNS
# Scenes of real meshes are listed where they have been fetched.
mkdir -- "$work/no_meshes"
export AABBLAB_DATA=$work/no_meshes

# store_help COMMAND…: the help of a command, and of those that it has.
store_help() {
    local file=$printed/help inner
    (($# == 0)) || printf -v file '%s' "$file" "${@/#//}"
    mkdir -p -- "$(dirname -- "$file")"
    "$program" "$@" --help >"$file.txt"
    while read -r inner; do
        [[ ! $inner ]] || store_help "$@" "$inner"
    done <<<"$(sed -nE '/^Subcommands:/,/^$/s/^  ([a-z_]+).*/\1/p' "$file.txt")"
}
store_help
"$program" list >"$printed/list.txt"

# What hangs on libraries that are not here is left as it is stored; columns are as wide as what is in them.
all_but_libraries() {
    awk '/^[^ ]/ { skipped = /^(engines|library_tests|integrators)/ } !skipped' "$1" | tr -s ' \n' ' '
}
if grep -q 'left out:' "$printed/list.txt"; then
    echo "This build lacks libraries, so what list says of engines and integrators is not compared."
    [[ ${2-} != --write ]] || exit 2
    if [[ $(all_but_libraries "$stored/list.txt") == "$(all_but_libraries "$printed/list.txt")" ]]; then
        cp -- "$stored/list.txt" "$printed/"
    fi
fi

if [[ ${2-} == --write ]]; then
    rm -rf -- "$stored"
    cp -r -- "$printed" "$stored"
elif ! diff -r -- "$stored" "$printed"; then
    echo 'The program prints what is not stored; tests/script/stored_output.bash build/release/aabblab --write stores it.'
    exit 1
fi
