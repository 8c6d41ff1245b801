# Sourced by the tests of ./aabblab: `checkout` has the script and what it reads, on a system that is made up. PATH has a
# few tools of this system, and those that a test writes to bin/.
# shellcheck shell=bash disable=SC2154

unset AABBLAB_PRESET AABBLAB_INSTALL AABBLAB_DATA
mkdir checkout bin sources
cp -r "$root"/{aabblab,CMakeLists.txt,CMakePresets.json,cmake} checkout/
for folder in modules strategies validation/engines paper experiments/stepping tests; do
    mkdir -p "checkout/$folder"
    cp "$root/$folder/CMakeLists.txt" "checkout/$folder/"
done
cp -r "$root/experiments/stored_output" checkout/experiments/
sed -i "s|/etc/os-release|$work/os-release|g; s|/etc/apt/sources.list.d|$work/sources|g" checkout/cmake/setup.bash
sed -i "s|/var/lib/dpkg/status|$work/packages|g" checkout/cmake/build.bash
touch packages
holds 'the system is made up' grep -q "$work/os-release" checkout/cmake/setup.bash
holds 'so are its package sources' grep -q "$work/sources" checkout/cmake/setup.bash
holds 'and what is installed on it' grep -q "$work/packages" checkout/cmake/build.bash
for tool in awk bash cat chmod chown cp cut dirname env find flock grep ln mkdir mkfifo mv readlink rm sed sh sleep sort tail tee timeout touch true uniq wc; do
    ln -s "$(type -P "$tool")" bin/
done

# program NAME: a command from what stands on standard input.
program() {
    cat >"bin/$1.part"
    chmod +x "bin/$1.part"
    mv "bin/$1.part" "bin/$1"
}

# Half a minute is too long for a test.
cat >quick <<'BASH'
read() { builtin read "${@/#30/0.1}"; }
BASH

# appears PATTERN FILE: waits for that line, for a minute at most.
appears() {
    for _ in {1..600}; do
        if grep -qsE -- "$1" "$2"; then return; fi
        sleep 0.1
    done
    return 1
}
