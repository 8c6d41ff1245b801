# Sourced by build.bash: what the build needs, and how it gets there. `root` and `build` are folders of the caller, whose
# `studies` is empty where what only single studies need is not wanted.
# shellcheck shell=bash disable=SC2154

# What the build needs: Debian's packages, Fedora's (- where there are none), and what shows that it is there on any
# system, which is a header, a command, or a version that `has` knows about.
needs=(
    'clang-19,libclang-rt-19-dev  clang,compiler-rt        clang++ 19 or newer'
    'clang-tools-19               clang-tools-extra        clang-scan-deps'
    'cmake                        cmake                    CMake 3.28 or newer'
    'ninja-build                  ninja-build              ninja'
    'catch2                       catch-devel              <catch2/catch_test_macros.hpp>'
    'librapidcheck-dev            -                        <rapidcheck.h>'
    'libbenchmark-dev             google-benchmark-devel   <benchmark/benchmark.h>'
    'libcgal-dev                  CGAL-devel               <CGAL/version.h>'
    'libboost-dev                 boost-devel              <boost/math/distributions/students_t.hpp>'
    'libtomlplusplus-dev          tomlplusplus-devel       <toml++/toml.h>'
    'libcli11-dev                 cli11-devel              <CLI/CLI.hpp>'
    'libeigen3-dev                eigen3-devel             <eigen3/Eigen/Core>'
    'libfmt-dev                   fmt-devel                <fmt/core.h>'
    'nlohmann-json3-dev           json-devel               <nlohmann/json.hpp>'
    'libxxhash-dev                xxhash-devel             <xxhash.h>'
    'libtbb-dev                   tbb-devel                <oneapi/tbb/task_arena.h>'
    'libssl-dev                   openssl-devel            <openssl/evp.h>'
    'libarchive-dev               libarchive-devel         <archive.h>'
)
# The same of what each engine needs, as its own line says. Where that is not to be had it is left out.
needs_in() { sed -nE 's/^aabblab_[a-z]+\(.* DEBIAN ([^ ]+) FEDORA ([^ ]+) SHOWS ([^ ]+)\)$/\1 \2 \3/p' "$root/$1/CMakeLists.txt"; }
mapfile -t optional_needs < <(needs_in validation/engines)
# What only a test needs, which is skipped without it.
optional_needs+=('valgrind valgrind valgrind')
# An integrator's library brings more than all the others, MPI and a Fortran compiler among it, and serves one study.
[[ ! $studies ]] || mapfile -t -O "${#optional_needs[@]}" optional_needs < <(needs_in experiments/stepping)
[[ $preset != lint ]] || needs+=(
    'clang-format-19   -  clang-format-19'
    'llvm-19-dev       -  llvm-config-19'
    'libclang-19-dev   -  </usr/lib/llvm-19/include/clang/Basic/Version.inc>'
)
# Debian 12 has versions this new in its backports only.
declare -gA least=([cmake]=3.28 [catch2]=3.0)
backports_file=/etc/apt/sources.list.d/aabblab-backports.sources

# at_least HAVE WANT: compares the first two numbers of two versions; no version is not enough.
at_least() {
    local major minor want_major want_minor
    IFS='.-+~' read -r major minor _ <<<"${1#*:}"
    IFS=. read -r want_major want_minor <<<"$2"
    [[ $major ]] && ((major > want_major || (major == want_major && ${minor:-0} >= want_minor)))
}

# What `paper` needs beside pdflatex: the packages that bring it, and the files that show it is there on any system.
tex_packages=(texlive-latex-base texlive-latex-recommended lmodern)
tex_rpms=(texlive-collection-latexrecommended texlive-lm)
tex_files=(
    article.cls amsmath.sty array.sty booktabs.sty caption.sty fontenc.sty geometry.sty graphicx.sty hyperref.sty
    lmodern.sty longtable.sty microtype.sty textcomp.sty lmr10.pfb
)

# Sets `system` to debian, where packages are installed, to apt or dnf, for which there is a line to tell, or to nothing;
# and `codename`, of a Debian only.
know_system() {
    local ID='' ID_LIKE='' VERSION_ID='' VERSION_CODENAME='' name
    # shellcheck source=/dev/null
    [[ ! -r /etc/os-release ]] || . /etc/os-release
    codename='' system=''
    [[ $ID != debian ]] || codename=$VERSION_CODENAME
    for name in $ID $ID_LIKE; do
        case $name in
        debian | ubuntu) system=apt ;;
        fedora) system=dnf ;;
        rhel | centos) ;; # like Fedora, but without most of the libraries
        *) continue ;;
        esac
        break
    done
    [[ $ID != debian || $VERSION_ID != 1[23] || $AABBLAB_INSTALL == no ]] || system=debian
}

# listed NAME…: with commas.
listed() {
    local names
    printf -v names ', %s' "$@"
    printf '%s' "${names:2}"
}

# ---- Set-up on Debian 12 and 13 --------------------------------------------------------------------------------------

# find_missing_packages PACKAGE…: sets `missing` to those that are not installed or too old.
find_missing_packages() {
    local name version status
    local -A installed=()
    while read -r name version status; do
        [[ $status != installed ]] || installed[$name]=$version
    done <<<"$(dpkg-query -W -f '${Package} ${Version} ${db:Status-Status}\n' "$@" 2>/dev/null)"
    missing=()
    for name in "$@"; do
        if [[ ! ${installed[$name]:-} ]] || ! at_least "${installed[$name]}" "${least[$name]:-0.0}"; then
            missing+=("$name")
        fi
    done
}

# signed_by FILE:NUMBER: the key option of an entry of the package sources, as apt names entries.
signed_by() {
    local file=${1%:*} number=${1##*:}
    if [[ $file == *.sources ]]; then
        sed '/^#/d' "$file" | awk -v RS= -v number="$number" 'NR == number' |
            awk '/^[^ \t]/ { wanted = tolower($1) ~ /^signed-by:/ } wanted'
    else
        sed -nE "${number}s/^[^#]*\[.*signed-by=([^] ]+).*/Signed-By: \1/p" "$file"
    fi
}

# Sets `wanted` to the names by which apt-get installs `missing`, and `backports` to what the package sources lack for
# that: Debian's backports, at the address from which this machine takes Debian itself.
name_wanted() {
    local name suite=$codename-backports release uri entry from='' origin there=''
    wanted=() backports=''
    for name in "${missing[@]}"; do
        if [[ $codename == bookworm && ${least[$name]:-} ]]; then name+=/$suite; fi
        wanted+=("$name")
    done
    [[ ${wanted[*]} == */* ]] || return 0
    # shellcheck disable=SC2016 # apt-get fills these in
    while read -r release uri entry; do
        if [[ $release == "$suite" ]]; then there=yes; fi
        if [[ $release == "$codename" ]]; then from=$uri origin=$entry; fi
    done <<<"$(apt-get indextargets --format '$(RELEASE) $(REPO_URI) $(SOURCESENTRY)' 'Created-By: Packages' 'Component: main')"
    if [[ ! $there && $from ]]; then
        printf -v backports 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\n%s' "$from" "$suite" "$(signed_by "$origin")"
    fi
}

# The line that installs `missing` with apt-get, for any shell of root's.
apt_line() {
    local wanted backports lines words=''
    name_wanted
    if [[ $backports ]]; then
        mapfile -t lines <<<"$backports"
        printf -v words ' %s' "${lines[@]@Q}"
        words="printf '%s\\n'$words >$backports_file && "
    fi
    printf '%s' "${words}apt-get update && apt-get install -y --no-install-recommends ${wanted[*]}"
}

# Ends with the reason why apt-get failed.
explain_apt() {
    local reason
    if reason=$(grep -m1 '^[EW]: Failed to fetch' "$apt_log"); then
        fail "packages cannot be downloaded (${reason#*: }); is there a network?"
    elif reason=$(grep -m1 -E '^E: (Unable to locate|Package|Version|Release)' "$apt_log"); then
        fail "the package sources of this machine lack a package (${reason#*: })."
    fi
    tail -n 20 "$apt_log" >&2
    fail 'apt-get failed; its whole output is in build/apt.log.'
}

# run_apt DOING ARGUMENT…
run_apt() {
    logged "$1" "$apt_log" "${as_root[@]}" DEBIAN_FRONTEND=noninteractive LC_ALL=C \
        apt-get -o DPkg::Lock::Timeout=300 "${@:2}"
}

# A source that we do not need may be out of reach; but then there is no long wait for the others.
update_apt() {
    run_apt 'updating package lists' -o APT::Update::Error-Mode=any -o Acquire::Retries=0 update || patience=(-o Acquire::Retries=0)
}

# Says how much apt-get is about to install for `wanted`, with all that these depend on. Where it can't, installing tells
# why.
say_how_much() {
    local plan versions sizes
    plan=$(LC_ALL=C apt-get -s install --no-install-recommends "${wanted[@]}" 2>/dev/null) || return 0
    mapfile -t versions < <(sed -nE 's/^Inst ([^ ]+) (\[[^]]*\] )?\(([^ ]+) .*/\1=\3/p' <<<"$plan")
    ((${#versions[@]} > 0)) || return 0
    sizes=$(apt-cache show "${versions[@]}" 2>>"$apt_log" | awk '
        /^Size:/ { bytes += $2 }
        /^Installed-Size:/ { kibibytes += $2 }
        END { printf "%.0f MB to download, %.0f MB on disk", bytes / 1e6, kibibytes * 1024 / 1e6 }') || explain_apt
    say "installing ${#versions[@]} packages with apt-get: $sizes"
}

install_wanted() { run_apt installing "${patience[@]}" install -y --no-install-recommends "${wanted[@]}"; }

# Does what is left to do where installing was cut short, by a signal or by a power cut.
repair_packages() {
    grep -qE '^E: (dpkg was interrupted|Unmet dependencies)' "$apt_log" || return 1
    say 'packages were being installed when that was cut short; repairing it with dpkg --configure -a and apt-get -f install'
    # What waits for packages that are not there yet cannot be configured.
    logged repairing "$apt_log" "${as_root[@]}" DEBIAN_FRONTEND=noninteractive dpkg --configure -a || true
    run_apt repairing "${patience[@]}" -f install -y
}

# install_missing PACKAGE…: installs what is missing of these.
install_missing() {
    local missing as_root=(env) apt_log=$root/build/apt.log patience=() wanted backports
    find_missing_packages "$@"
    ((${#missing[@]} > 0)) || return 0
    if ((EUID != 0)); then
        as_root=(sudo env)
        { command -v sudo >/dev/null && sudo true; } ||
            fail_lacking 'root or sudo is needed to install what is missing' "${missing[@]}"
    fi
    say "not installed here: ${missing[*]}; asking apt-get how much that is"
    : >"$apt_log"
    update_apt
    name_wanted
    if [[ $backports ]]; then
        say "adding $codename-backports to the package sources as $backports_file"
        "${as_root[@]}" tee "$backports_file" <<<"$backports" >/dev/null
        update_apt
    fi
    say_how_much
    install_wanted || { repair_packages && install_wanted; } || explain_apt
    find_missing_packages "$@"
    ((${#missing[@]} == 0)) || fail "apt-get installed no version new enough of: ${missing[*]}."
}

# ---- Where nothing is installed ---------------------------------------------------------------------------------------

# how_to_install SENTENCE: adds to it, where we know it, the line that installs what is missing: Debian's packages
# `missing`, Fedora's packages `rpms`. `unpackaged` is what Fedora has no package of.
how_to_install() {
    local line='' what=it sentence=$1
    case $system in
    debian | apt) line=$(apt_line) ;;
    dnf)
        ((${#rpms[@]} == 0)) || line="dnf install -y ${rpms[*]}"
        if ((${#unpackaged[@]} > 0)); then
            sentence+="; Fedora has no package of $(listed "${unpackaged[@]}")" what='the rest'
        fi
        ;;
    esac
    [[ ! $line ]] || sentence+="; as root, this installs $what:"$'\n'"  $line"
    printf '%s' "$sentence"
}

# fail_lacking WHY WHAT…
fail_lacking() {
    local sentence
    sentence=$(how_to_install "$1: $(listed "${@:2}")")
    [[ $sentence == *$'\n'* ]] || sentence+=.
    fail "$sentence"
}

# Why nothing is installed.
no_installing() {
    if [[ $AABBLAB_INSTALL == no ]]; then
        printf "AABBLAB_INSTALL is 'no', and"
    else
        printf 'packages are installed on Debian 12 and 13 only, and'
    fi
}

# has WHAT: is it there? Without any compiler no header can be found, and a package too many does no harm.
has() {
    case $1 in
    clang++*) [[ $compiler ]] ;;
    clang-scan-deps) command -v "clang-scan-deps${compiler#clang++}" clang-scan-deps >/dev/null ;;
    CMake*) at_least "$(cmake --version 2>/dev/null | sed -n '1s/[^0-9]*//p')" "${least[cmake]}" ;;
    \<*) "${compiler:-c++}" -E -x c++ -include "${1:1:-1}" /dev/null >/dev/null 2>&1 ;;
    *) command -v "$1" >/dev/null ;;
    esac
}

# note_lacking NEED: adds it to `lacking` and its packages to the others, where it is not there.
note_lacking() {
    local debian fedora what names
    read -r debian fedora what <<<"$1"
    if has "$what"; then return; fi
    lacking+=("$what")
    IFS=, read -ra names <<<"$debian"
    missing+=("${names[@]}")
    IFS=, read -ra names <<<"$fedora"
    if [[ $fedora == - ]]; then unpackaged+=("$what"); else rpms+=("${names[@]}"); fi
}

# Sets `compiler`, or ends with all that is missing. Without what only they need there is a build all the same.
find_tools() {
    local lacking=() missing=() rpms=() unpackaged=() need essential
    for compiler in clang++-{19..29} clang++ ''; do
        if at_least "$("${compiler:-false}" -dumpversion 2>/dev/null)" 19.0; then break; fi
    done
    for need in "${needs[@]}"; do note_lacking "$need"; done
    essential=${#lacking[@]}
    for need in "${optional_needs[@]}"; do note_lacking "$need"; done
    ((essential == 0)) || fail_lacking "$(no_installing) here is missing" "${lacking[@]}"
    ((${#lacking[@]} == 0)) ||
        say "$(how_to_install "engines, integrators and tests that need $(listed "${lacking[@]}") are left out")"
}

# ----------------------------------------------------------------------------------------------------------------------

# Debian's packages of what the build needs.
build_packages() {
    local debian need
    for need in "${needs[@]}" "${optional_needs[@]}"; do
        read -r debian _ <<<"$need"
        printf '%s\n' "${debian//,/$'\n'}"
    done
}

# Installs what is missing or ends with one sentence. Sets `compiler` where it is not the one of the presets.
set_up() {
    local packages
    know_system
    if [[ $system == debian ]]; then
        mapfile -t packages <<<"$(build_packages)"
        install_missing "${packages[@]}"
    elif [[ ! -e $build/build.ninja || $studies ]]; then
        find_tools
    fi
}

# Sets `lacking` to what TeX lacks for the paper.
find_missing_tex() {
    local name found
    lacking=(pdflatex)
    command -v pdflatex >/dev/null || return 0
    lacking=()
    found=$(kpsewhich "${tex_files[@]}" 2>/dev/null) || true
    for name in "${tex_files[@]}"; do
        [[ $'\n'$found$'\n' == *"/$name"$'\n'* ]] || lacking+=("$name")
    done
}

# As set_up, but what `paper` needs, whether or not anything is built.
set_up_tex() {
    local lacking missing=("${tex_packages[@]}") rpms=("${tex_rpms[@]}") unpackaged=()
    find_missing_tex
    ((${#lacking[@]} > 0)) || return 0
    know_system
    [[ $system == debian ]] || fail_lacking "$(no_installing) TeX lacks here" "${lacking[@]}"
    install_missing "${tex_packages[@]}"
    find_missing_tex
    ((${#lacking[@]} == 0)) ||
        fail "${tex_packages[*]} are installed, but TeX does not find $(listed "${lacking[@]}")."
}
