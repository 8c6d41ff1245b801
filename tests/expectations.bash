# Sourced by the tests of scripts: a folder `work` to be in, gone with the test, and `failures`.
# shellcheck shell=bash

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cd -- "$work"

failures=0
# expect WHAT STATUS PATTERN COMMAND…: the status, and a line of the output that matches.
expect() {
    local what=$1 wanted=$2 pattern=$3 output status=0
    shift 3
    output=$("$@" 2>&1) || status=$?
    if ((status != wanted)) || ! grep -qE -- "$pattern" <<<"$output"; then
        printf '%s: status %d, output:\n%s\n' "$what" "$status" "$output"
        failures=$((failures + 1))
    fi
}
# holds WHAT COMMAND…
holds() {
    "${@:2}" || {
        printf '%s: not so\n' "$1"
        failures=$((failures + 1))
    }
}
