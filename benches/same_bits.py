"""Compares what two builds of the program wrote: see same_bits.sh."""

import json
import pathlib
import re
import sys

EXPECTED = pathlib.Path(__file__).with_name("same_bits.expected")
# what differs between any two runs, or holds the text of a plan
SKIPPED = {"timings.json", "report.html", "study.html", "time", "stderr"}
# files under another name today
RENAMED = {"rig.json": "tests.json"}
LEFT_OUT = {"provenance", "plan", "hash", "version"}


def expected():
    """Lines `PATTERN: reason`; a difference whose line matches a pattern is named with its reason and counts as expected."""
    lines = EXPECTED.read_text().splitlines() if EXPECTED.exists() else []
    pairs = [line.split(": ", 1) for line in lines if line and not line.startswith("#")]
    return [(re.compile(pattern), reason) for pattern, reason in pairs]


def leaves(value, path=""):
    """Every number and text of a JSON value with its path."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in LEFT_OUT:
                yield from leaves(inner, f"{path}.{key}")
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{index}]")
    else:
        yield path, value


def json_differences(old, new):
    old, new = dict(leaves(json.loads(old))), dict(leaves(json.loads(new)))
    for path in old.keys() | new.keys():
        if repr(old.get(path)) != repr(new.get(path)):
            yield f"{path}: {old.get(path)} -> {new.get(path)}"


def differences(old, new, name):
    for path in sorted(p for p in old.rglob("*") if p.is_file()):
        inner = path.relative_to(old)
        if path.name in SKIPPED or inner.parts[0].startswith("."):
            continue
        other = new / inner.with_name(RENAMED.get(path.name, path.name))
        if not other.exists():
            yield f"{name}/{inner}: missing"
            continue
        a, b = path.read_bytes(), other.read_bytes()
        if path.name == "stdout":
            a, b = (re.sub(rb"\([0-9.]+ s\)|/\S*/(old|new)/", b"", text) for text in (a, b))
        if a == b:
            continue
        if path.suffix == ".json" and path.name not in RENAMED:
            yield from (f"{name}/{inner} {d}" for d in sorted(json_differences(a, b))[:20])
        elif path.name not in RENAMED:
            lines = zip(a.splitlines(), b.splitlines())
            first = next((f"{x[:120]!r} -> {y[:120]!r}" for x, y in lines if x != y), "other length")
            yield f"{name}/{inner}: {first}"


def main(old, new, pattern):
    known = expected()
    unexpected, cases, files = 0, 0, 0
    for case in sorted(path for path in old.iterdir() if (path / "exit").exists()):
        if not (new / case.name / "exit").exists():
            continue
        cases += 1
        files += sum(1 for path in case.rglob("*") if path.is_file())
        for difference in differences(case, new / case.name, case.name):
            reason = next((reason for match, reason in known if match.search(difference)), None)
            unexpected += reason is None
            print(f"{'expected' if reason else 'DIFFERS '} {difference}" + (f"  ({reason})" if reason else ""))
    print(f"{cases} cases, {files} files, {unexpected} differences that nobody expected")
    return 1 if unexpected else 0


sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]))
