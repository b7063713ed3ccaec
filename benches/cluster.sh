#!/usr/bin/env bash
# The time of one study by every executor, on this machine: the table of docs/cluster.md. Needs what tests/slurm/cluster.sh needs.
#
#   tests/slurm/cluster.sh benches/cluster.sh BINARY
set -euo pipefail
[[ $# = 1 && -x $1 ]] || { echo "usage: tests/slurm/cluster.sh benches/cluster.sh BINARY" >&2; exit 2; }
binary=$(realpath "$1") folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/many.track" <<'SCENE'
use std
scenario { title = "Many short points", allow = [stiffness_jump: "short", track_too_short: "short", critical_speed: "short", wheel_on_track: "short"] }
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 8 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s, law = laws.varandas_2014 }
study many {
  vary = [ore.speed: 60 .. 180 km/h, open.support.stiffness: 30 .. 80 MN/m per seat]
  sampling = sobol(400), minimise = max(settlement)
}
SCENE
study() {
    "$binary" study "$folder/many.track" --out "$folder/out" "$@" >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
}
workers() {
    study --executor workers
    local tasks
    tasks=$(grep -o 'holds [0-9]*' "$folder/log" | grep -o '[0-9]*')
    seq 0 $((tasks - 1)) | xargs -P "$(nproc)" -n 1 "$binary" work "$folder/out" --threads 1 >/dev/null
    study --resume
}
for how in "study --jobs 1" "study --jobs $(nproc)" workers "study --executor slurm"; do
    for _ in 1 2 3; do
        rm -rf "$folder/out"
        begun=$(date +%s.%N)
        $how
        awk -v how="$how" -v begun="$begun" -v ended="$(date +%s.%N)" 'BEGIN { printf "%-28s %.2f s\n", how, ended - begun }'
        sha256sum "$folder/out/study.csv" | cut -c1-16 >>"$folder/answers"
    done
done
[[ $(sort -u "$folder/answers" | wc -l) = 1 ]] || { echo "the answers differ" >&2; exit 1; }
