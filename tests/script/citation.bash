#!/usr/bin/env bash
# Does CITATION.cff name the version that is built, and the day on which CHANGELOG says that it was released?
set -euo pipefail

root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
# shellcheck source=tests/expectations.bash
. "$root/tests/expectations.bash"

version=$(sed -nE 's/^ +VERSION ([0-9.]+)$/\1/p' "$root/CMakeLists.txt")
released=$(sed -nE "s/^## \[${version//./\\.}\] - //p" "$root/CHANGELOG.md")
holds 'a version' test "$version"
holds 'a release' test "$released"
holds 'the version' grep -qx "version: $version" "$root/CITATION.cff"
holds 'its release' grep -qx "date-released: $released" "$root/CITATION.cff"

exit $((failures > 0))
