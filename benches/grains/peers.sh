#!/usr/bin/env bash
# The grain kernel beside other programs on the same beds under the same law, in turns, on the same machine.
#
#   benches/grains/peers.sh [--out TABLE.csv] [--steps N] [--repeat N] [--cores '1 2'] [--cases 'spheres clumps']
#                           [--only 'liggghts lammps-A lammps-B yade'] [--warm N]; TRACKBED=PROGRAM takes one that is built, SKIN=M another skin
#
# Cases: `spheres` is bed10k.xyzr copied 5 x 2 (100,000 spheres), `small` the bed itself, `clumps` clumps10k.txt. Programs:
# liggghts, lmp (twice, see peers/lammps.in) and yade, where they are installed (Debian: liggghts lammps yade openmpi-bin).
# Every round runs each program once, so that a busy machine slows all of them; the table has medians over the rounds, and
# what `trackbed` does per second over what the other does. YADE, being slower, takes a fifth of the steps.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out="" steps=500 warm=100 repeat=5 cores="1 2" cases="spheres clumps" only="" skin=${SKIN:-0.004}
while [ $# -gt 0 ]; do
    [ $# -ge 2 ] || { echo "peers.sh: $1 needs a value" >&2; exit 2; }
    case $1 in
        --out) out=$2 ;; --steps) steps=$2 ;; --warm) warm=$2 ;; --repeat) repeat=$2 ;;
        --cores) cores=$2 ;; --cases) cases=$2 ;; --only) only=$2 ;;
        *) echo "peers.sh: unknown option $1" >&2; exit 2 ;;
    esac
    shift 2
done
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ -z "${TRACKBED:-}" ]; then
    cargo build --release --quiet --manifest-path "$here/../../Cargo.toml"
    TRACKBED=$here/../../target/release/trackbed
fi

# What a case is: file, copies along x and y, its size there in m.
bed() {
    case $1 in
        small) echo "$here/bed10k.xyzr 1 1 1.2 1.2" ;;
        spheres) echo "$here/bed10k.xyzr 5 2 6.0 2.4" ;;
        clumps) echo "$here/clumps10k.txt 1 1 2.4 1.2" ;;
        *) echo "peers.sh: unknown case $1" >&2; exit 2 ;;
    esac
}

# Writes the bed of a case as a file for YADE and one for LIGGGHTS and LAMMPS, which want places inside the period.
prepare() {
    read -r file nx ny lx ly <<< "$(bed "$1")"
    awk -v nx="$nx" -v ny="$ny" -v px="$(awk "BEGIN{print $lx/$nx}")" -v py="$(awk "BEGIN{print $ly/$ny}")" '
        /^#/ { next }
        { line[++n] = $0 }
        END { for (i = 0; i < nx; i++) for (j = 0; j < ny; j++) for (k = 1; k <= n; k++) {
            m = split(line[k], v, " "); v[m - 3] += i * px; v[m - 2] += j * py
            for (c = 1; c <= m; c++) printf "%s%s", (c < m - 3 ? v[c] : sprintf("%.9f", v[c])), (c < m ? " " : "\n")
        } }' "$file" > "$work/$1.xyzr"
    awk -v lx="$lx" -v ly="$ly" '
        function floor(v) { return v >= 0 ? int(v) : -int(-v) - (v < int(v)) }
        {
            i = floor($(NF - 3) / lx); j = floor($(NF - 2) / ly); if ($(NF - 1) > top) top = $(NF - 1)
            atom[NR] = sprintf("%d 1 %.9f 2700 %.9f %.9f %s %d %d 0", NR, 2 * $NF, $(NF - 3) - i * lx, $(NF - 2) - j * ly, $(NF - 1), i, j)
            if (NF == 5) body[NR] = $1
        }
        END {
            printf "bed of grains\n\n%d atoms\n1 atom types\n\n0 %s xlo xhi\n0 %s ylo yhi\n-0.01 %.3f zlo zhi\n\nAtoms\n\n", NR, lx, ly, top + 0.3
            for (k = 1; k <= NR; k++) print atom[k]
            if (1 in body) { print "\nClumps\n"; for (k = 1; k <= NR; k++) print k, body[k] }
        }' "$work/$1.xyzr" > "$work/$1.data"
}

# One run (LIGGGHTS leaves a log where it stands); prints steps, seconds and, of spheres, kinetic energy in J.
once() {
    local program=$1 case=$2 n=$3 launch=()
    read -r file nx ny lx ly <<< "$(bed "$case")"
    [ "$n" = 1 ] || launch=(mpirun -np "$n")
    local kind=spheres
    [ "$case" != clumps ] || kind=clumps
    local input=(-var data "$work/$case.data" -var skin "$skin" -var warm "$warm" -var steps "$steps" -log none)
    local told='/^ *[0-9]+ +[-+.0-9e]+ *$/ { energy = $2 } /^Loop time/ { seconds = $4 } END { print steps, seconds, energy }'
    case $program in
        trackbed)
            "$TRACKBED" bench grains --bed "$file" --copies "${nx}x$ny" --warm "$warm" --steps "$steps" --threads "$n" --format json |
                awk -v steps="$steps" -F '[:,]' '/^  "seconds"/ { s = $2 } /^  "kinetic_energy"/ { e = $2 } END { print steps, s, e }' ;;
        liggghts) (cd "$work" && "${launch[@]}" liggghts -in "$here/peers/liggghts.in" "${input[@]}") | awk -v steps="$steps" "$told" ;;
        lammps-*) "${launch[@]}" lmp -in "$here/peers/lammps.in" -var kind "$kind" -var law "${program#lammps-}" "${input[@]}" |
            awk -v steps="$steps" "$told" ;;
        yade)
            local few=$((steps / 5 > 0 ? steps / 5 : 1))
            KIND=$kind FILE=$work/$case.xyzr SIZE="$lx $ly" SKIN=$skin WARM=$((warm / 5)) STEPS=$few \
                yade -n -x -j"$n" "$here/peers/yade.py" 2> /dev/null | awk -v steps="$few" '/^Loop time/ { print steps, $4 }' ;;
    esac
}

# Programs that can run a case.
programs() {
    local name list="trackbed"
    command -v lmp > /dev/null && list+=" lammps-B lammps-A"
    [ "$1" = clumps ] || ! command -v liggghts > /dev/null || list+=" liggghts"
    command -v yade > /dev/null && list+=" yade"
    for name in $list; do
        [ -z "$only" ] || [ "$name" = trackbed ] || [[ " $only " == *" $name "* ]] || continue
        echo "$name"
    done
}

median() { sort -g | awk '{ v[NR] = $1 } END { print (NR % 2) ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }

table=$work/table.csv
echo "case,bodies,cores,program,rounds,million_body_steps_per_second,lowest,highest,trackbed_is_faster_by,kinetic_energy_J" > "$table"
for case in $cases; do
    prepare "$case"
    bodies=$(awk 'NF == 5 { last[$1]; next } { n++ } END { for (c in last) n++; print n }' "$work/$case.xyzr")
    for n in $cores; do
        for round in $(seq "$repeat"); do
            for program in $(programs "$case"); do
                echo "$case, $n cores, round $round of $repeat: $program" >&2
                read -r did seconds energy <<< "$(once "$program" "$case" "$n")"
                [ -n "${seconds:-}" ] || { echo "peers.sh: $program gave no time" >&2; exit 1; }
                awk "BEGIN { print $bodies * $did / $seconds / 1e6 }" >> "$work/$case.$n.$program"
                echo "${energy:-}" > "$work/$case.$n.$program.energy"
            done
        done
        ours=$(median < "$work/$case.$n.trackbed")
        for program in $(programs "$case"); do
            speeds=$work/$case.$n.$program
            speed=$(median < "$speeds")
            awk -v OFS=, -v s="$speed" -v ours="$ours" -v low="$(sort -g "$speeds" | head -1)" -v high="$(sort -g "$speeds" | tail -1)" \
                -v energy="$([ "$case" = clumps ] || cat "$speeds.energy")" -v head="$case,$bodies,$n,$program,$repeat" '
                function four(v) { return sprintf("%.4g", v) }
                BEGIN { print head, four(s), four(low), four(high), sprintf("%.2f", ours / s), (energy == "" ? "" : sprintf("%.7g", energy)) }' >> "$table"
        done
    done
done
awk -F, '{ printf "%-9s%8s%7s  %-10s%8s%32s%10s%10s%24s%19s\n", $1, $2, $3, $4, $5, $6, $7, $8, $9, $10 }' "$table"
[ -z "$out" ] || { cp "$table" "$out"; echo "wrote $out" >&2; }
