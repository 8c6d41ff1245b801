# Sourced by ./aabblab where its targets are not built: what is answered without a build, how the program is built, and
# what is said meanwhile. `root`, `preset`, `build`, `stamp`, `studies` and `targets` are the caller's.
# shellcheck shell=bash disable=SC2154
set -o pipefail

log=$build/build.log
# What package managers write to whenever they change something.
package_databases=(/var/lib/dpkg/status /var/lib/rpm/* /var/lib/pacman/local)

say() { printf 'aabblab: %s\n' "$*" >&2; }
fail() {
    say "$*"
    exit 2
}

# print_stored ARGUMENT…: what the program prints for these, where that is stored (tests/script/stored_output.bash).
# Only a build knows which libraries are there.
print_stored() {
    local stored=$root/experiments/stored_output words=$* file line
    case $words in
    -h | --help) file=help ;;
    *\ -h | *\ --help)
        words=${words% *}
        # Of what a command is given beside, its help says the same.
        while [[ $words == *\ * && ! -r $stored/help/${words// //}.txt ]]; do words=${words% *}; done
        file=help/${words// //}
        ;;
    list) file=list ;;
    *) return 1 ;;
    esac
    [[ -r $stored/$file.txt ]] || return 1
    while IFS= read -r line; do
        case $file/$line in
        list/engines* | list/library_tests* | list/integrators*)
            line+=' (availability unknown: nothing is built yet)'
            ;;
        esac
        printf '%s\n' "$line"
    done <"$stored/$file.txt"
}

# The options of what only this script has.
help_on() {
    case $1 in
    test) printf 'aabblab test [OPTION…]: builds and runs every test; options go to ctest, as in -R axial_cut.\n' ;;
    data) printf 'aabblab data [--dragon]: fetches the real meshes; --dragon also the Stanford dragon, from npm.\n' ;;
    benchmark) printf 'aabblab benchmark [OPTION…]: times each stage of global search, each test of local detection and each build alone; options are Google Benchmark'"'"'s, as in\n--benchmark_filter=sort/ or --benchmark_list_tests.\n' ;;
    paper) printf 'aabblab paper [RESULTS_DIR] [--out FILE.pdf]: the report of a reproduction as a PDF, by default from results/reproduce\n(results/reproduce-quick where only that is there) to RESULTS_DIR/paper.pdf. Installs TeX where it is missing.\n' ;;
    esac
}

# contained COMMAND…: runs it in a process group of its own, which ends with this script when that is told to end.
contained() {
    local group status=0
    set -m
    "$@" &
    set +m
    group=$!
    # shellcheck disable=SC2064 # the group is known now
    trap "kill -- -$group 2>/dev/null || true; exit 130" INT TERM HUP
    wait "$group" || status=$?
    trap - INT TERM HUP
    return "$status"
}

# Appends lines to a file and shows the last one as progress.
show_into() {
    local line
    while IFS= read -r line; do
        printf '%s\n' "$line" >>"$1"
        printf '\r\e[K%s' "${line:0:79}" >&2
    done
    printf '\r\e[K' >&2
}

# tell_at_times DOING FILE: says every half minute how far the command has come that writes the file. Ends when the script
# does, which holds the other end of its input and writes nothing there.
tell_at_times() {
    local last
    SECONDS=0
    while read -r -t 30 _ || (($? > 128)); do
        last=$(tail -n 1 -- "$2")
        if [[ $last =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
            say "$1, ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} after $SECONDS s"
        else
            say "$1 after $SECONDS s: ${last:0:79}"
        fi
    done
}

# logged DOING FILE COMMAND…: appends the command's output to the file. On a terminal its last line shows as progress,
# elsewhere there is a line every half minute.
logged() {
    local doing=$1 file=$2 out shown status=0
    shift 2
    if [[ -t 2 ]]; then
        exec {out}> >(trap '' INT; show_into "$file")
        shown=$!
        "$@" >&"$out" 2>&1 {out}>&- || status=$?
    else
        exec {out}> >(tell_at_times "$doing" "$file" >&2)
        shown=$!
        "$@" >>"$file" 2>&1 {out}>&- || status=$?
    fi
    exec {out}>&-
    wait "$shown" || true
    return "$status"
}

# One call at a time sets up and builds.
lock() {
    { mkdir -p "$build" && : >>"$root/build/.lock"; } 2>/dev/null || fail "$root/build cannot be written."
    exec {lock}>>"$root/build/.lock"
    flock -w 1 "$lock" || {
        say 'waiting for another aabblab to finish building'
        flock "$lock"
    }
}
unlock() { exec {lock}>&-; }

# A checkout that was copied or moved brings a build folder along that still builds what lies at the old place.
leave_old_place() {
    local cache=$build/CMakeCache.txt source folder
    source=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$cache" 2>/dev/null) || return 0
    folder=$(sed -n 's/^CMAKE_CACHEFILE_DIR:INTERNAL=//p' "$cache")
    if [[ ! $source || ($source -ef $root && $folder -ef $build) ]]; then return; fi
    say "build/$preset belongs to $source; it is emptied and configured for $root"
    find "$build/" -mindepth 1 -delete || fail "build/$preset cannot be emptied."
}

# any_newer FILE THAN…: is any of the others newer?
any_newer() {
    local file
    for file in "${@:2}"; do
        if [[ $file -nt $1 ]]; then return; fi
    done
    return 1
}

# Later changes of CMakeLists.txt make the build configure itself; presets and packages are not among what it watches.
configure() {
    if [[ ! -e $build/build.ninja ]]; then
        say "building in build/$preset"
        logged configuring "$log.new" contained cmake --fresh --preset "$preset" -S "$root" ${compiler:+-DCMAKE_CXX_COMPILER="$compiler"} ||
            return
        sed -n 's/^-- \(.*: the integrator .* is left out\)/aabblab: \1/p' "$log.new" >&2
    elif any_newer "$build/build.ninja" "$root/CMakePresets.json" "${package_databases[@]}"; then
        logged configuring "$log.new" contained cmake --preset "$preset" -S "$root"
    fi
}

# Compilers use much memory once, and page faults are slow on virtual machines: in pages of 2 MiB, where the kernel has
# them, a build takes up to a third less time.
large_pages=glibc.malloc.hugetlb=1:glibc.malloc.top_pad=16777216:glibc.malloc.mmap_threshold=1073741824

# Builds the targets, and leaves the whole output in the log, unless there was nothing to do.
build() {
    : >"$log.new"
    # shellcheck disable=SC2086 # names of targets
    # Described before it is built, so that what changes meanwhile is newer.
    if configure && { describe_build >"$stamp.new" || rm -- "$stamp.new"; } &&
        logged building "$log.new" contained env GLIBC_TUNABLES="$large_pages" cmake --build "$build" --target $targets; then
        if [[ -e $stamp.new ]]; then mv -- "$stamp.new" "$stamp"; fi
        if [[ $(<"$log.new") != *'no work to do.' ]]; then mv "$log.new" "$log"; fi
        return
    fi
    mv "$log.new" "$log"
    tail -n 40 "$log" >&2
    fail "the build failed; its whole output is in build/$preset/build.log."
}

# What is written down of a build: where it was made, then what must be older than it, which is files at absolute paths,
# and all there is of the sources.
describe_build() {
    local file databases=0 ref
    printf '%s\n' "of $root" "$build/build.ninja"
    for file in "${package_databases[@]}"; do
        if [[ -e $file ]]; then
            printf '%s\n' "$file"
            databases=1
        fi
    done
    # Without any, nobody can tell whether libraries have changed but the build.
    ((databases)) || return 1
    # The program knows its commit, and whether the sources differ from it (cmake/AabblabCommit.cmake).
    ref=$(git -C "$root" symbolic-ref -q HEAD 2>/dev/null) || ref=HEAD
    for file in HEAD index packed-refs "$ref"; do
        git -C "$root" rev-parse --path-format=absolute --git-path "$file" 2>/dev/null || break
    done
    {
        printf '%s\n' CMakeLists.txt CMakePresets.json cmake
        sed -nE 's/^ *add_subdirectory\(([^ )]+).*/\1/p' "$root/CMakeLists.txt"
        git -C "$root" ls-tree --name-only HEAD 2>/dev/null || true
    } | sort -u | if [[ $targets == all ]]; then cat; else grep -vx tests; fi
}

# paper [RESULTS_DIR] [--out FILE.pdf]: typesets what `reproduce` left. Nothing has to be built for it.
paper() {
    local results='' out=''
    while (($# > 0)); do
        case $1 in
        --out=?*) out=${1#*=} ;;
        --out)
            [[ ${2-} ]] || fail 'paper: --out takes one value.'
            out=$2
            shift
            ;;
        -*) fail "paper: there is no option '$1'; see aabblab paper --help." ;;
        *)
            [[ $1 && ! $results ]] || fail "paper: unexpected argument '$1'; see aabblab paper --help."
            results=$1
            ;;
        esac
        shift
    done
    if [[ ! $results ]]; then
        results=results/reproduce
        if [[ ! -d $results && -d results/reproduce-quick ]]; then
            results=results/reproduce-quick
            say "results/reproduce is not there; the paper is of $results"
        fi
    fi
    [[ -d $results ]] || fail "there are no results in $results; run ./aabblab reproduce first."
    [[ -r $results/macros.tex ]] || fail "$results has no macros.tex; run ./aabblab reproduce first."
    : "${out:=${results%/}/paper.pdf}"
    [[ $out == *?.pdf ]] || fail "paper: --out is '$out'; its name must end in .pdf."
    # The log of TeX stands beside it, under a longer name.
    { mkdir -p -- "$(dirname -- "$out")" && [[ ! -d $out ]] && : >"$out.log" && rm -f -- "$out.log"; } 2>/dev/null ||
        fail "$out cannot be written."

    lock
    set_up_tex
    unlock
    exec "$root/paper/tex/build" "$results" "$out"
}

# prepare ARGUMENT…: answers what needs no build, and ends there; else sets up what is missing and builds.
prepare() {
    [[ $preset =~ ^(debug|release|bench|lint)$ ]] || fail "AABBLAB_PRESET is '$preset'; it must be debug, release, bench or lint."
    [[ $AABBLAB_INSTALL =~ ^(yes|no|all)$ ]] || fail "AABBLAB_INSTALL is '$AABBLAB_INSTALL'; it must be yes, no or all."
    if [[ $1 =~ ^(test|data|benchmark|paper)$ && ${2-} =~ ^(-h|--help)$ ]]; then
        help_on "$1"
        exit
    fi
    if [[ ! -x $build/aabblab ]] && print_stored "$@"; then exit; fi
    [[ $1 != data ]] || exec "$root/experiments/data/fetch" "${@:2}"
    root=$(readlink -f -- "$root")
    # shellcheck source=cmake/setup.bash
    . "$root/cmake/setup.bash"
    [[ $1 != paper ]] || paper "${@:2}"
    lock
    leave_old_place
    set_up
    build
    unlock
}
