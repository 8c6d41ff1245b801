#!/usr/bin/env bash
# What ./aabblab says, and installs, where something is missing: on systems that are made up, and never as root.
set -euo pipefail

root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
# shellcheck source=tests/expectations.bash
. "$root/tests/expectations.bash"
# shellcheck source=tests/script/checkout.bash
. "$root/tests/script/checkout.bash"

user=()
if ((EUID == 0)); then
    user=("$(command -v setpriv)" --reuid=65534 --regid=65534 --clear-groups)
    chown -R 65534:65534 "$work"
fi
aabblab() { "${user[@]}" "$work/checkout/aabblab" "$@"; }
no_installing() { AABBLAB_INSTALL=no aabblab "$@"; }
# on WHAT: the system is this, and nothing has been installed on it.
on() {
    printf '%s\n' "$@" >os-release
    : >installed
    : >calls
    chmod a+w installed calls
}

# dpkg-query knows what stands in `installed`; apt-get has the newest of everything, and notes what it is called with.
program dpkg-query <<'SH'
#!/bin/sh
while read -r name; do echo "$name 99.0-1 installed"; done <"$WORK/installed"
SH
program apt-get <<'SH'
#!/bin/sh
echo "$*" >>"$WORK/calls"
case "$*" in
indextargets*) cat "$WORK/targets" ;;
-s*)
    if [ -e "$WORK/unmet" ]; then
        echo 'E: Unmet dependencies. Try apt --fix-broken install with no packages (or specify a solution).'
        exit 100
    fi
    for name; do
        case $name in -* | install) ;; *) echo "Inst ${name%/*} (1-2 Debian:12.15/oldstable [amd64])" ;; esac
    done
    echo 'Inst libgmp10 [1-1] (1:2-3 Debian:12.15/oldstable [amd64])'
    echo 'Conf libgmp10 (1:2-3 Debian:12.15/oldstable [amd64])'
    ;;
*'-f install'*) rm -f "$WORK/unmet" ;;
*install*)
    if [ -e "$WORK/unmet" ]; then
        echo 'E: Unmet dependencies. Try apt --fix-broken install with no packages (or specify a solution).'
        exit 100
    fi
    if [ -e "$WORK/cut_short" ]; then
        echo "E: dpkg was interrupted, you must manually run 'dpkg --configure -a' to correct the problem. "
        exit 100
    fi
    while [ -e "$WORK/slow" ]; do
        echo 'Unpacking clang-19 ...'
        sleep 0.1
    done
    for name; do echo "${name%/*}"; done >>"$WORK/installed"
    ;;
esac
SH
# Each takes 2 MB, and 1.024 MB when it is installed; no other version of it is asked for.
program apt-cache <<'SH'
#!/bin/sh
for name; do
    case $name in
    show) ;;
    *=1-2 | libgmp10=1:2-3) printf 'Package: %s\nInstalled-Size: 1000\nSize: 2000000\nDescription: x\n Size: 3\n\n' "$name" ;;
    *) exit 1 ;;
    esac
done
SH
program dpkg <<'SH'
#!/bin/sh
echo "dpkg $*" >>"$WORK/calls"
[ "$*" = '--configure -a' ] && rm "$WORK/cut_short"
SH
printf '#!/bin/sh\nexec "$@"\n' | program sudo_of_tests
printf 'Types: deb\nURIs: http://here/debian\nSuites: bookworm\nComponents: main\nSigned-By: /keys/debian\n' >here.sources
printf 'bookworm http://here/debian %s/here.sources:1\n' "$work" >targets
export PATH=$work/bin WORK=$work

everything='clang\+\+ 19 or newer, clang-scan-deps, CMake 3.28 or newer, ninja, <catch2/catch_test_macros.hpp>,'
everything+=' <rapidcheck.h>, <benchmark/benchmark.h>, <CGAL/version.h>,'
everything+=' <boost/math/distributions/students_t.hpp>, <toml\+\+/toml.h>, <CLI/CLI.hpp>, <eigen3/Eigen/Core>, <fmt/core.h>,'
everything+=' <nlohmann/json.hpp>, <xxhash.h>, <oneapi/tbb/task_arena.h>, <openssl/evp.h>, <archive.h>, <fcl/config.h>, <ccd/ccd.h>,'
everything+=' <embree4/rtcore.h>, <bullet/LinearMath/btScalar.h>, <ode/ode.h>, valgrind'
tools='clang-19 libclang-rt-19-dev clang-tools-19'
libraries='librapidcheck-dev libbenchmark-dev libcgal-dev libboost-dev'
libraries+=' libtomlplusplus-dev libcli11-dev libeigen3-dev libfmt-dev nlohmann-json3-dev libxxhash-dev libtbb-dev libssl-dev libarchive-dev'
libraries+=' libfcl-dev libccd-dev libembree-dev libbullet-dev libode-dev valgrind'
all="$tools cmake ninja-build catch2 $libraries"
install='apt-get update && apt-get install -y --no-install-recommends'

# ---- Where nothing is ever installed ----

here='aabblab: packages are installed on Debian 12 and 13 only, and here is missing:'
fedora='clang compiler-rt clang-tools-extra cmake ninja-build catch-devel google-benchmark-devel CGAL-devel'
fedora+=' boost-devel tomlplusplus-devel cli11-devel eigen3-devel fmt-devel json-devel xxhash-devel tbb-devel openssl-devel'
fedora+=' libarchive-devel libccd-devel embree-devel bullet-devel valgrind'
unpackaged='Fedora has no package of <rapidcheck.h>, <fcl/config.h>, <ode/ode.h>'
on ID=fedora
expect 'a bare Fedora' 2 "^$here $everything; $unpackaged; as root, this installs the rest:$" aabblab pairs
expect 'its line' 2 "^  dnf install -y $fedora$" aabblab pairs
on ID=nobara 'ID_LIKE="fedora"'
expect 'what is like Fedora' 2 "^  dnf install -y $fedora$" aabblab pairs
on ID=ubuntu 'ID_LIKE=debian' VERSION_CODENAME=noble
expect 'a bare Ubuntu' 2 "^$here $everything; as root, this installs it:$" aabblab pairs
expect 'its line' 2 "^  $install $all$" aabblab pairs
on ID=linuxmint 'ID_LIKE="ubuntu debian"'
expect 'what is like Ubuntu' 2 "^  $install $all$" aabblab pairs
# Of another Debian nobody knows where its backports are.
on ID=debian VERSION_ID=11 VERSION_CODENAME=bullseye
expect 'an older Debian' 2 "^  $install $all$" aabblab pairs
for other in $'ID=rocky\nID_LIKE="rhel centos fedora"' ID=arch; do
    on "$other"
    expect "$other" 2 "^$here $everything\.$" aabblab pairs
    holds "$other has no line" test "$(aabblab pairs 2>&1 | wc -l)" = 1
done

# A compiler that finds every header but two, and nothing else.
program clang++-20 <<'SH'
#!/bin/sh
case "$*" in
-dumpversion) echo 20.1.2 ;;
*rapidcheck.h* | *xxhash.h*) exit 1 ;;
esac
SH
for tool in clang-scan-deps-20 ninja valgrind; do printf '#!/bin/sh\n' | program "$tool"; done
printf '#!/bin/sh\necho cmake version 3.27.9\n' | program cmake
on ID=fedora
expect 'some is there' 2 "here is missing: CMake 3.28 or newer, <rapidcheck.h>, <xxhash.h>; Fedora has no package of <rapidcheck.h>; " aabblab pairs
expect 'the line of the rest' 2 '^  dnf install -y cmake xxhash-devel$' aabblab pairs
sed -i 's/ \*xxhash.h\*/ nothing/' bin/clang++-20
printf '#!/bin/sh\necho cmake version 3.28.3\n' | program cmake
expect 'nothing that Fedora has is missing' 2 'here is missing: <rapidcheck.h>; Fedora has no package of <rapidcheck.h>\.$' aabblab pairs
# What only engines need is told with the rest, and alone keeps nothing from being built.
sed -i 's| nothing| *fcl/config.h*|' bin/clang++-20
expect 'an engine and more cannot be had' 2 'here is missing: <rapidcheck.h>, <fcl/config.h>; Fedora has no package' aabblab pairs
sed -i 's/^\*rapidcheck.h\*/nothing/' bin/clang++-20
expect 'an engine is left out' 127 '^aabblab: engines, integrators and tests that need <fcl/config.h> are left out; Fedora has no package of <fcl/config.h>$' aabblab pairs
# An integrator's library is told of where its study is asked for.
sed -i 's|\*fcl/config.h\*|*cvode/cvode.h*|' bin/clang++-20
holds 'a study that nobody asked for' test -z "$(aabblab pairs 2>&1 | grep cvode)"
expect 'a study that lacks its library' 127 'integrators and tests that need <cvode/cvode.h> are left out; as root, this installs it:$' \
    aabblab validate stiff --quick
expect 'its line' 127 '^  dnf install -y sundials-devel$' aabblab validate stiff --quick
AABBLAB_INSTALL=all expect 'its line, for the asking' 127 '^  dnf install -y sundials-devel$' aabblab pairs
rm -r checkout/build
rm bin/clang++-20 bin/clang-scan-deps-20 bin/ninja bin/valgrind bin/cmake

# ---- Debian ----

backports="printf '%s\\\\n' 'Types: deb' 'URIs: http://here/debian' 'Suites: bookworm-backports' 'Components: main'"
backports+=" 'Signed-By: /keys/debian' >$work/sources/aabblab-backports.sources"
newer="$tools cmake/bookworm-backports ninja-build catch2/bookworm-backports $libraries"
on ID=debian VERSION_ID=12 VERSION_CODENAME=bookworm
expect 'neither root nor sudo' 2 \
    "^aabblab: root or sudo is needed to install what is missing: ${all// /, }; as root, this installs it:$" aabblab pairs
expect 'its line' 2 "^  $backports && $install $newer$" aabblab pairs
printf 'bookworm-backports http://here/debian %s/here.sources:1\n' "$work" >>targets
expect 'a Debian that has its backports' 2 "^  $install $newer$" aabblab pairs
sed -i '$d' targets
holds 'nothing is installed' test ! -s installed
on ID=debian VERSION_ID=13 VERSION_CODENAME=trixie
expect 'the next Debian' 2 "^  $install $all$" aabblab pairs

for ask in 'pairs' 'validate extreme' 'validate stiff' 'pairs with all'; do
    install_which=yes wanted="$all"
    [[ $ask != *all ]] || install_which=all
    [[ $ask != *stiff && $ask != *all ]] || wanted+=' libsundials-dev'
    # shellcheck disable=SC2086 # words
    AABBLAB_INSTALL=$install_which expect "$ask" 2 "^  $install $wanted$" aabblab ${ask% with all}
done

cp bin/sudo_of_tests bin/sudo
on ID=debian VERSION_ID=12 VERSION_CODENAME=bookworm
expect 'nothing shall be installed' 2 \
    "^aabblab: AABBLAB_INSTALL is 'no', and here is missing: $everything; as root, this installs it:$" no_installing pairs
expect 'its line' 2 "^  $backports && $install $newer$" no_installing pairs
holds 'apt-get is only asked where Debian comes from' test "$(cut -d ' ' -f 1 calls | uniq)" = indextargets
line=$(no_installing pairs 2>&1 | sed -n 's/^  //p') || true
"${user[@]}" sh -c "$line" # as a user would
holds 'the line adds the backports' grep -qx 'Suites: bookworm-backports' sources/aabblab-backports.sources
holds 'and installs' grep -qx "install -y --no-install-recommends $newer" calls
AABBLAB_INSTALL=maybe expect 'not an answer' 2 "^aabblab: AABBLAB_INSTALL is 'maybe'; it must be yes, no or all\.$" aabblab pairs

rm sources/aabblab-backports.sources
on ID=debian VERSION_ID=12 VERSION_CODENAME=bookworm
touch slow
chmod a+w .
BASH_ENV=$work/quick aabblab pairs 2>heard &
script=$!
holds 'it says what apt-get does' appears '^aabblab: installing after [0-9]+ s: Unpacking clang-19 \.\.\.$' heard
rm slow
wait "$script" || true # there is still nothing to build with
holds 'the backports are added' grep -qx 'URIs: http://here/debian' sources/aabblab-backports.sources
holds 'with their key' grep -qx 'Signed-By: /keys/debian' sources/aabblab-backports.sources
holds 'all is installed' grep -q "install -y --no-install-recommends $newer$" calls
packages=$(($(wc -w <<<"$newer") + 1)) # and libgmp10
amount="aabblab: installing $packages packages with apt-get: $((packages * 2)) MB to download, $(((packages * 1024 + 500) / 1000)) MB on disk"
holds 'it said what is missing' grep -qx "aabblab: not installed here: $all; asking apt-get how much that is" heard
expect 'and how much that is, before it installed' 0 "^$amount$" grep -m 1 ' installing ' heard

# Killed while it installed.
on ID=debian VERSION_ID=13 VERSION_CODENAME=trixie
touch cut_short
repairing='^aabblab: packages were being installed when that was cut short; repairing it with dpkg --configure -a and apt-get -f install$'
expect 'it is repaired' 2 "$repairing" aabblab pairs
holds 'by dpkg' grep -qx 'dpkg --configure -a' calls
holds 'and installed then' test "$(tail -n 1 calls)" = "-o DPkg::Lock::Timeout=300 install -y --no-install-recommends $all"
holds 'as a whole' test "$(wc -w <installed)" -ge "$(wc -w <<<"$all")"
: >installed
touch unmet
expect 'where dependencies are missing, it is repaired, too' 2 "$repairing" aabblab pairs
holds 'by apt-get' grep -qx -e '-o DPkg::Lock::Timeout=300 -f install -y' calls
holds 'and then all is installed' test "$(wc -w <installed)" -ge "$(wc -w <<<"$all")"

# ---- The paper ----

mkdir -p results
touch results/macros.tex
chmod a+w results
rm bin/sudo
tex='TeX lacks here: pdflatex'
on ID=fedora
expect 'TeX on Fedora' 2 "^aabblab: packages are installed on Debian 12 and 13 only, and $tex; as root, this installs it:$" aabblab paper results
expect 'its line' 2 '^  dnf install -y texlive-collection-latexrecommended texlive-lm$' aabblab paper results
on ID=debian VERSION_ID=12 VERSION_CODENAME=bookworm
debian_tex='texlive-latex-base texlive-latex-recommended lmodern'
expect 'TeX without root' 2 "root or sudo is needed to install what is missing: ${debian_tex// /, }; as root" aabblab paper results
expect 'its line' 2 "^  $install $debian_tex$" aabblab paper results
expect 'TeX shall not be installed' 2 "^aabblab: AABBLAB_INSTALL is 'no', and $tex; as root, this installs it:$" no_installing paper results
holds 'TeX is not installed' test ! -s installed

exit $((failures > 0))
