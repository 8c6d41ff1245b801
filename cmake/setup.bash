# Sourced by ./aabblab: what the build needs, and how it gets there. `root` and `build` are folders of the caller.
# shellcheck shell=bash disable=SC2154

packages=(
    clang-19 clang-tools-19 libclang-rt-19-dev cmake ninja-build
    catch2 librapidcheck-dev libbenchmark-dev
    libcgal-dev libfcl-dev libccd-dev libeigen3-dev libassimp-dev
    libboost-dev libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libxxhash-dev
)
# Debian's packages of gnuplot exclude each other, and any of them will do.
command -v gnuplot >/dev/null || packages+=(gnuplot-nox)
[[ ${AABBLAB_LINT:-0} == 0 ]] || packages+=(clang-format-19 clang-tidy-19)
# Debian 12 has versions this new in its backports only.
declare -A least=([cmake]=3.28 [catch2]=3.0)
# What shows that a library is there on a system without dpkg.
headers=(
    catch2/catch_test_macros.hpp rapidcheck.h benchmark/benchmark.h CGAL/version.h fcl/config.h ccd/ccd.h
    boost/math/distributions/students_t.hpp eigen3/Eigen/Core assimp/scene.h toml++/toml.h CLI/CLI.hpp fmt/core.h nlohmann/json.hpp xxhash.h
)

# at_least HAVE WANT: compares the first two numbers of two versions; no version is not enough.
at_least() {
    local major minor want_major want_minor
    IFS='.-+~' read -r major minor _ <<<"${1#*:}"
    IFS=. read -r want_major want_minor <<<"$2"
    [[ $major ]] && ((major > want_major || (major == want_major && ${minor:-0} >= want_minor)))
}

# What `paper` needs beside pdflatex: the packages that bring it, and the files that show it is there on any system.
tex_packages=(texlive-latex-base texlive-latex-recommended lmodern)
tex_files=(
    article.cls amsmath.sty array.sty booktabs.sty caption.sty fontenc.sty geometry.sty graphicx.sty hyperref.sty
    lmodern.sty longtable.sty microtype.sty textcomp.sty lmr10.pfb
)

# ---- Set-up on Debian 12 and 13 --------------------------------------------------------------------------------------

# Sets `codename` and succeeds on a Debian that we install on.
on_debian() {
    local ID='' VERSION_ID='' VERSION_CODENAME=''
    # shellcheck source=/dev/null
    [[ ! -r /etc/os-release ]] || . /etc/os-release
    codename=$VERSION_CODENAME
    [[ $ID == debian && $VERSION_ID == 1[23] ]]
}

# Sets `missing` to the packages that are not installed or too old.
find_missing_packages() {
    local name version status
    local -A installed=()
    while read -r name version status; do
        [[ $status != installed ]] || installed[$name]=$version
    done <<<"$(dpkg-query -W -f '${Package} ${Version} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null)"
    missing=()
    for name in "${packages[@]}"; do
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

# Adds Debian's backports at the address from which this machine takes Debian itself, unless they are there.
add_backports() {
    local suite=$codename-backports file=/etc/apt/sources.list.d/aabblab-backports.sources release uri entry from='' origin
    # shellcheck disable=SC2016 # apt-get fills these in
    local fields='$(RELEASE) $(REPO_URI) $(SOURCESENTRY)'
    while read -r release uri entry; do
        if [[ $release == "$suite" ]]; then return; fi
        if [[ $release == "$codename" ]]; then from=$uri origin=$entry; fi
    done <<<"$(apt-get indextargets --format "$fields" 'Created-By: Packages' 'Component: main')"
    [[ $from ]] || explain_apt
    say "adding $suite to the package sources as $file"
    { printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\n' "$from" "$suite" && signed_by "$origin"; } |
        "${as_root[@]}" tee "$file" >/dev/null
    update_apt
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

run_apt() {
    logged installing "$apt_log" "${as_root[@]}" DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -o DPkg::Lock::Timeout=300 "$@"
}

# A source that we do not need may be out of reach; but then there is no long wait for the others.
update_apt() {
    run_apt -o APT::Update::Error-Mode=any -o Acquire::Retries=0 update || patience=(-o Acquire::Retries=0)
}

install_packages() {
    local as_root=(env) apt_log=$root/build/apt.log patience=() wanted=() newer=() name
    if ((EUID != 0)); then
        as_root=(sudo env)
        { command -v sudo >/dev/null && sudo true; } || fail "root or sudo is needed to install: ${missing[*]}."
    fi
    say "installing with apt-get: ${missing[*]}"
    : >"$apt_log"
    update_apt
    for name in "${missing[@]}"; do
        if [[ $codename == bookworm && ${least[$name]:-} ]]; then newer+=("$name/bookworm-backports"); else wanted+=("$name"); fi
    done
    ((${#newer[@]} == 0)) || add_backports
    run_apt "${patience[@]}" install -y --no-install-recommends "${wanted[@]}" "${newer[@]}" || explain_apt
    find_missing_packages
    ((${#missing[@]} == 0)) || fail "apt-get installed no version new enough of: ${missing[*]}."
}

# listed NAME…: with commas.
listed() {
    local names
    printf -v names ', %s' "$@"
    printf '%s' "${names:2}"
}

# ---- Other systems ---------------------------------------------------------------------------------------------------

# Sets `compiler`, or ends with all that is missing.
find_tools() {
    local lacking=() header
    for compiler in clang++-{19..29} clang++ ''; do
        if at_least "$("${compiler:-false}" -dumpversion 2>/dev/null)" 19.0; then break; fi
    done
    [[ $compiler ]] || lacking+=('clang++ 19 or newer')
    command -v "clang-scan-deps${compiler#clang++}" clang-scan-deps >/dev/null || lacking+=(clang-scan-deps)
    at_least "$(cmake --version 2>/dev/null | sed -n '1s/[^0-9]*//p')" 3.28 || lacking+=('CMake 3.28 or newer')
    command -v ninja >/dev/null || lacking+=(ninja)
    command -v gnuplot >/dev/null || lacking+=(gnuplot)
    for header in "${headers[@]}"; do
        [[ ! $compiler ]] || "$compiler" -E -x c++ -include "$header" /dev/null >/dev/null 2>&1 || lacking+=("<$header>")
    done
    ((${#lacking[@]} == 0)) ||
        fail "packages are installed on Debian 12 and 13 only, and here is missing: $(listed "${lacking[@]}")."
}

# ----------------------------------------------------------------------------------------------------------------------

# Installs what is missing or ends with one sentence. Sets `compiler` where it is not the one of the presets.
set_up() {
    if on_debian; then
        find_missing_packages
        ((${#missing[@]} == 0)) || install_packages
    elif [[ ! -e $build/build.ninja ]]; then
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
    local lacking packages=("${tex_packages[@]}")
    find_missing_tex
    ((${#lacking[@]} > 0)) || return 0
    if on_debian; then
        find_missing_packages
        ((${#missing[@]} == 0)) || install_packages
        find_missing_tex
        ((${#lacking[@]} > 0)) || return 0
        fail "${tex_packages[*]} are installed, but TeX does not find $(listed "${lacking[@]}")."
    fi
    fail "packages are installed on Debian 12 and 13 only, and TeX lacks here $(listed "${lacking[@]}")."
}
