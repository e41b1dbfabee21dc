#!/usr/bin/env bash
# Runs Duet from a clone: installs what is missing (Debian 12), builds what has changed, then does
# what was asked. When nothing has changed this adds less than a second.

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
preset=release
# Where CI=true, the tests' build takes warnings for errors; people's builds do not, for a newer
# compiler may warn of more.
if [[ ${1:-} == test && ${CI:-} == true ]]; then preset=ci; fi
build=$root/build/$preset
programs=(duet duet-solid duet-fluid)

usage() {
    cat <<'TEXT'
./duet.sh run CASE [...]      run a case, for example cases/hot_plate
./duet.sh verify CASE [...]   run it and hold it against its reference data
./duet.sh check CASE          check a case file and show what would be modelled
./duet.sh test [...]          build everything and run every test (options go to ctest)
./duet.sh build [TARGET ...]  build everything, or these targets
./duet.sh --help              this text; every other command and option goes to `duet`
                              (./duet.sh run --help shows those of `run`)

Missing Debian packages are installed and what has changed is built first; the programs are in
build/release/bin.
TEXT
}

say() { printf '%s\n' "$*" >&2; }
die() {
    say "duet.sh: $*"
    exit 1
}

# Debian's tools and libraries only: a Python or compiler environment that is active in the caller's
# shell (conda, pyenv, modules) would lend headers and libraries that do not fit. Runs keep the
# caller's environment, for the solvers that people bring.
only_debian() {
    export PATH=/usr/sbin:/usr/bin:/sbin:/bin
    unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS CPATH C_INCLUDE_PATH CPLUS_INCLUDE_PATH \
        LIBRARY_PATH LD_LIBRARY_PATH PKG_CONFIG_PATH CMAKE_PREFIX_PATH CMAKE_GENERATOR PYTHONPATH \
        PYTHONHOME
}

# Progress of a long job: `watch_log PID LOG WHAT COMMAND` says WHAT and what COMMAND makes of the
# log, from two seconds on; on a terminal in one line that is overwritten, else every 30 s.
watch_log() {
    local pid=$1 log=$2 what=$3 count=$4 waited=0 status=0
    # A shell's background job ignores Ctrl-C, so it is passed on.
    trap 'kill "$pid" 2>/dev/null; wait "$pid" 2>/dev/null; exit 130' INT TERM
    while kill -0 "$pid" 2>/dev/null; do
        if ((waited >= 20)); then
            if [[ -t 2 ]]; then
                ((waited % 5)) || printf '\r\033[K%s%s' "$what" "$("$count" "$log")" >&2
            elif ((waited == 20 || waited % 300 == 0)); then
                say "$what$("$count" "$log")"
            fi
        fi
        sleep 0.1
        waited=$((waited + 1))
    done
    wait "$pid" || status=$?
    trap - INT TERM
    if [[ -t 2 ]] && ((waited > 20)); then printf '\r\033[K' >&2; fi
    return "$status"
}

ninja_count() { sed -n 's|^\[\([0-9]*\)/\([0-9]*\)\].*|: \1 of \2 steps|p' "$1" | tail -n 1; }
ctest_count() { sed -n 's|^ *\([0-9]*\)/\([0-9]*\) Test .*|: \1 of \2|p' "$1" | tail -n 1; }
apt_count() {
    awk '/ newly installed,/ {total = $3}
         /^Unpacking / {done += 0.5}
         /^Setting up / {done += 0.5}
         END {if (total && done) printf ": %d of %d packages", done, total}' "$1"
}

# ---------------------------------------------------------------------------------------- packages

missing_packages() {
    local wanted
    mapfile -t wanted < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/.ci/packages.txt")
    # dpkg-query exits with 1 when it does not know one of them; that one is then missing.
    comm -23 <(printf '%s\n' "${wanted[@]}" | sort) \
        <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null |
            sed -n 's/ installed$//p' | sort)
}

install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        die "this is not a Debian system, so packages cannot be installed here." \
            "Install what .ci/packages.txt names, then: cmake --preset release &&" \
            "cmake --build --preset release"
    fi
    local missing as_root=()
    mapfile -t missing < <(missing_packages)
    ((${#missing[@]})) || return 0
    if ((EUID != 0)); then
        # Without a terminal sudo cannot ask for a password.
        if ! command -v sudo >/dev/null || { ! sudo -n true 2>/dev/null && [[ ! -t 0 ]]; }; then
            die "these packages are missing and neither root nor sudo is at hand." \
                "Ask an administrator for: apt-get install ${missing[*]}"
        fi
        sudo -v
        as_root=(sudo)
    fi
    say "Installing ${missing[*]}"
    mkdir -p "$root/build"
    local log=$root/build/packages.log
    {
        "${as_root[@]}" apt-get update &&
            "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
                apt-get install --yes --no-install-recommends "${missing[@]}"
    } >"$log" 2>&1 </dev/null &
    watch_log $! "$log" "Installing packages" apt_count || {
        tail -n 20 "$log" >&2
        die "installing packages failed; the whole log is $log"
    }
}

# ------------------------------------------------------------------------------------------- build

configure() {
    local home=""
    if [[ -f $build/build.ninja ]]; then
        home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
    fi
    # Ninja itself configures again when a CMake file changes; a moved clone starts afresh.
    [[ $home != "$root" ]] || return 0
    cmake --fresh -S "$root" --preset "$preset" -DCMAKE_IGNORE_PREFIX_PATH=/usr/local
}

# As many compilers as there are cores, and no more than the memory holds (about 1.5 GB each).
jobs() {
    local cores by_memory
    cores=$(nproc)
    by_memory=$(awk '/^MemAvailable/ {print 1 + int($2 / 1.5e6)}' /proc/meminfo)
    echo $((cores < by_memory ? cores : by_memory))
}

# Builds the given targets, or everything; what the tools say goes to build.log.
build() {
    mkdir -p "$build"
    local log=$build/build.log
    {
        # One build at a time: a second duet.sh waits for the first.
        flock 9
        (cd "$root" && configure && exec ninja -C "$build" -j "$(jobs)" "$@") \
            >"$log" 2>&1 </dev/null 9>&- &
        watch_log $! "$log" "Building Duet" ninja_count || {
            # Ninja's steps and what CMake found are no help; the errors are.
            { grep -v -e '^\[' -e '^-- ' "$log" || true; } | tail -n 60 >&2
            die "the build failed; the whole log is $log"
        }
    } 9>"$root/build/lock"
}

# -------------------------------------------------------------------------------------------- test

run_tests() {
    local log=$build/test.log status=0
    # The tests share the cores; a waiting OpenMP thread must not hold one.
    OMP_WAIT_POLICY=passive ctest --test-dir "$build" -j "$(nproc)" --output-on-failure "$@" \
        >"$log" 2>&1 </dev/null &
    watch_log $! "$log" "Testing" ctest_count || status=$?

    # What a failed test printed stands below its line, up to the next test's line.
    awk '/^ *[0-9]+\/[0-9]+ Test +#/ {show = !/ Passed |\*\*\*Skipped | \(Disabled\)/}
         /^ +Start +[0-9]+:/ {next}
         /^[0-9]+% tests passed/ {show = 0}
         show' "$log"
    awk -v status="$status" '
        !/^ *[0-9]+\/[0-9]+ Test +#/ {next}
        / Passed / {passed++; next}
        /\*\*\*Skipped | \(Disabled\)/ {skipped++; next}
        {failed++}
        END {
            # ctest can fail without a failed test: when there are none, or it cannot start.
            if (!failed && (status || !passed)) failed = 1
            printf "%d passed, %d failed", passed, failed
            if (skipped) printf ", %d skipped", skipped
            print ""
            exit failed > 0
        }' "$log"
}

# -------------------------------------------------------------------------------------------- draw

# The histories of the run just made, beside the references of its case, as a picture in its folder.
draw_histories() {
    local folder= arguments=("$@") i
    for i in "${!arguments[@]}"; do
        case ${arguments[i]} in
        --output) folder=${arguments[i + 1]:-} ;;
        --output=*) folder=${arguments[i]#--output=} ;;
        -h | --help) return ;;
        esac
    done
    [[ $folder ]] || folder=$(ls -1td runs/*/ 2>/dev/null | head -n 1) || return 0
    folder=${folder%/}
    if [[ -s $folder/probes.csv && $folder/probes.csv -nt $started ]] \
        && "$root/tools/plot_probes.py" "$folder" --output "$folder/probes.png" 2>>"$folder/log.txt"; then
        echo "its histories, beside their references, are drawn in $folder/probes.png"
    fi
}

# -------------------------------------------------------------------------------------------- main

set_up() (
    only_debian
    install_packages
    build "$@"
)

case ${1:-} in
"" | -h | --help | help)
    usage
    ;;
build)
    set_up "${@:2}"
    ;;
test)
    only_debian
    if ! set_up; then
        echo "0 passed, 1 failed"
        exit 1
    fi
    run_tests "${@:2}"
    ;;
run | verify)
    set_up "${programs[@]}"
    status=0
    started=$build/.started
    touch "$started"
    # Should this script be killed, the run ends as if it had been told to.
    setpriv --pdeathsig TERM "$build/bin/duet" "$@" || status=$?
    [[ $status -gt 1 ]] || draw_histories "$@"
    exit "$status"
    ;;
*)
    set_up "${programs[@]}"
    exec "$build/bin/duet" "$@"
    ;;
esac
