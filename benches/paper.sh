#!/usr/bin/env bash
# The long runs of the paper's scene and of the shortened one: every tier on five packings, the interval of exchange, wagons alone and a train,
# the number of bays, bays of a cell, 500 axles in every tier. Hours to days on two cores; it goes on where it was stopped.
#
#   benches/paper.sh BINARY DIR [PATTERN]
#
# DIR keeps one directory a run, its output (NAME.log) and what it took (NAME.time). What is finished there is not run again, what was begun goes on by
# `--resume`. PATTERN chooses runs by name, such as `tier_` or `bays_|cell_`. `benches/paper.py DIR` makes the tables of docs/validation.md of them.
set -uo pipefail
[[ $# -ge 2 && -x $1 ]] || { echo "usage: benches/paper.sh BINARY DIR [PATTERN]; BINARY is a program that was built" >&2; exit 2; }
binary=$(realpath "$1") dir=$2 pattern=${3:-.}
here=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$dir" && dir=$(realpath "$dir")
cd "$here/scenarios" || exit 2

# run NAME SCENE ARGUMENTS: one run, from where it is
run() {
    local name=$1 scene=$2 status
    shift 2
    [[ $name =~ $pattern ]] || return 0
    [[ -f $dir/$name/summary.json ]] && return 0
    local resume=()
    [[ -d $dir/$name ]] && resume=(--resume)
    echo "$name"
    local begun=$SECONDS
    "$binary" run "$scene" "$@" "${resume[@]}" --out "$dir/$name" >>"$dir/$name.log" 2>&1
    status=$?
    echo "$((SECONDS - begun)) s, status $status" >>"$dir/$name.time"
}

short=transition_short.track full=transition_full.track
twenty=(--set 'traffic.total=20 axles' --set 'track_response.after=[0, 20] axles')

# three bays: how often forces and settlement are exchanged, against none (monolithic)
three=("${twenty[@]}" --set 'solve.window=-1.8 .. 1.2 m')
for seed in 1 2; do
    run "interval_20_$seed" $short "${three[@]}" --seed $seed
    run "interval_4_$seed" $short "${three[@]}" --seed $seed --set 'solve.update_every=4 axles'
    run "interval_adaptive_$seed" $short "${three[@]}" --seed $seed --set 'solve.update_every=adaptive(0.05 mm)'
    run "interval_none_$seed" $short "${three[@]}" --seed $seed --set solve.coupling=monolithic
    run "interval_alone_$seed" $short "${three[@]}" --seed $seed --set solve.passages=isolated
done

# every tier on five packings
for seed in 1 2 3 4 5; do
    run "tier_cells_$seed" $short "${twenty[@]}" --seed $seed --set solve.substructure=cells
    run "tier_full_$seed" $short "${twenty[@]}" --seed $seed
done
run tier_law_1 $short "${twenty[@]}" --set solve.substructure=law

for bays in 1 2 3; do
    run "cell_$bays" $short --set solve.substructure=cells --set solve.cell_bays=$bays
done

# bays under grains, 20 axles
volume=(--set 'ballast_response.at=-3 sleepers' --set 'ballast_response.after=20 axles')
run bays_12 $full "${twenty[@]}" "${volume[@]}" --set 'solve.window=-7.2 .. 1.2 m'
run bays_18 $full "${twenty[@]}" "${volume[@]}" --set 'solve.window=-10.8 .. 1.2 m'
run bays_40 $full "${twenty[@]}" "${volume[@]}"

# what the paper leaves open, one reading a line (docs/readings.md)
hundred=(--set 'traffic.total=100 axles' --set 'solve.update_every=20 axles' --set 'track_response.after=[0, 20, 40, 60, 80, 100] axles'
    --set 'ballast_response.after=100 axles' --set solve.substructure=cells)
run reading_pressed $full "${hundred[@]}"
run reading_eased $full "${hundred[@]}" --set ballast.packing.restored=eased
run reading_unloaded $full "${hundred[@]}" --set ballast.packing.restored=unloaded
run reading_tamped $full "${hundred[@]}" --set ballast.packing.restored=eased --set ballast.packing.friction=0.2 --set subballast.packing.friction=0
run reading_half_stiffness $full "${hundred[@]}" --set 'ballast.contact_stiffness=6.5 MN/m per contact' \
    --set 'subballast.contact_stiffness=2.5 MN/m per contact'
run reading_loaded_again $full "${hundred[@]}" --set ballast.packing.reloads=1
run reading_loaded_three_times $full "${hundred[@]}" --set ballast.packing.reloads=3
run reading_eased_loaded_again $full "${hundred[@]}" --set ballast.packing.restored=eased --set ballast.packing.reloads=1
run reading_smooth_walls $full "${hundred[@]}" --set ballast.wall_friction=0 --set subballast.wall_friction=0
run reading_heavy $full "${hundred[@]}" --set 'wagon.axle_load=29.5 t'
run reading_crib $full "${hundred[@]}" --set 'open.crib=150 mm' --set 'stiff.crib=none'

# the paper's 500 axles
counts=(--set 'track_response.after=[0, 20, 100, 200, 300, 400, 500] axles')
run axles_cells $full "${counts[@]}" --set solve.substructure=cells
run axles_cells_as_read $full "${counts[@]}" --set solve.substructure=cells --set ballast.packing.restored=eased
run axles_zone $full "${counts[@]}" --set solve.substructure=zone
run axles_full $full "${counts[@]}"
