#!/usr/bin/env bash
# Runs what is shipped with two builds of the program and compares every number that comes out, bit by bit.
#
#   benches/same_bits.sh OLD NEW DIR [PATTERN]
#
# OLD and NEW are two binaries, DIR keeps what they wrote (DIR/old, DIR/new): what is there is not run again, so that an old build
# runs once. PATTERN chooses cases by name, such as `run_`, or `check_|resolve_`. With nothing else running it takes about an hour on two
# cores; most of it are the studies and the packing of `bian_rig`, which runs one cycle here.
#
# Compared are the tables (.csv, .parquet, .vtp), diagnostics, drawings, and all numbers of every JSON but two: `provenance`, which holds the text
# of the plan, and `timings.json`. What must differ between two versions stands in `benches/same_bits.expected`, each with its reason.
set -uo pipefail
old=$1 new=$2 dir=$3 pattern=${4:-.}
here=$(cd "$(dirname "$0")/.." && pwd)
cd "$here" || exit 2

cases() {
    for scene in scenarios/*.track tests/scenes/*.track; do
        name=$(basename "${scene%.track}")
        [[ $scene == tests/* ]] && name=tests_$name
        echo "check_$name check $scene --format json"
        echo "resolve_$name resolve $scene"
        echo "draw_$name draw $scene --out OUT.svg"
    done
    for name in static_check sleepers pads usp wedge transition bridge oedometer box_test triaxial; do
        echo "run_$name run scenarios/$name.track --out OUT"
    done
    echo "run_transition_adaptive run scenarios/transition.track --set solve.update_every=adaptive(0.003 mm) --out OUT"
    echo "run_full_as_law run scenarios/transition_full.track --set solve.substructure=law --out OUT"
    for name in pads spacing speed support usp wedge density; do
        echo "study_$name study scenarios/study_$name.track --out OUT"
    done
    echo "run_bian_rig run scenarios/bian_rig.track --set actuators.total=1 cycles --set pressure.after=[1] cycles --out OUT"
}

# record BUILD FOLDER: runs the cases whose answer is not there yet
record() {
    local binary=$1 folder=$2
    mkdir -p "$folder"
    export TRACKBED_CACHE=$folder/beds
    cases | grep -E "^($pattern)|^[a-z]*_($pattern) |$pattern" | while read -r name command; do
        [[ -e $folder/$name/exit ]] && continue
        rm -rf "${folder:?}/$name"
        mkdir -p "$folder/$name"
        # one word for each option, and the rest of the line after `--set` up to the next option
        mapfile -t words < <(sed 's/ --/\n--/g; s/^\([a-z]*\) /\1\n/' <<<"$command" | sed 's/^\(--[a-z]*\) /\1\n/')
        words=("${words[@]//OUT/$folder/$name/out}")
        ( time "$binary" "${words[@]}" >"$folder/$name/stdout" 2>"$folder/$name/stderr" ) 2>"$folder/$name/time"
        echo $? >"$folder/$name/exit"
        echo "$folder $name $(grep real "$folder/$name/time")"
    done
}

record "$old" "$dir/old"
record "$new" "$dir/new"
python3 benches/same_bits.py "$dir/old" "$dir/new" "$pattern"
