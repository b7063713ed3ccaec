"""Kills and damages what the program keeps, and says whether anything was lost, mixed or believed.

    python3 benches/attack.py BINARY FOLDER [KILLS] [DAMAGES]

Runs a track, a test rig, a packing and a study of a moment each. KILLS times (200 where it is not said) one of them is killed, at a random
time or as soon as a file of its directory changes, resumed, killed again, resumed to its end, and every file compared with one that was never
killed. DAMAGES times (100) a bit of a kept file is turned over, the file cut, emptied or taken away: the program must say so by the name of the
file or give the same answer. One core and two must give the same bytes.
"""

import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

binary, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
kills, damages = (int(sys.argv[k]) if len(sys.argv) > k else n for k, n in ((3, 200), (4, 100)))
here = pathlib.Path(__file__).resolve().parent.parent
random.seed(1)

TRACK = [
    "run", here / "scenarios/transition.track", "--set", "traffic.total=240 axles", "--set", "track_response.after=[0, 120, 240] axles",
    "--set", "solve.elements_per_bay=1", "--set", "solve.time_step=2e-4 s",
]
RIG = ["run", here / "scenarios/box_test.track", "--set", "actuator.total=2 cycles", "--set", "stone.scale=1.8", "--set", "pressure.after=[1, 2] cycles"]
PACK = ["pack", here / "scenarios/box_test.track", "--set", "stone.scale=1.8"]
STUDY = ["study", folder / "study.track", "--set", "traffic.total=40 axles", "--set", "solve.elements_per_bay=1", "--set", "solve.time_step=2e-4 s"]
WORKS = {"track": TRACK, "rig": RIG, "pack": PACK, "study": STUDY}
# differs between any two runs, or says where the cache lies
CHANGING = {"timings.json", "manifest.json", "report.html", "study.html", "bed.html"}


def command(name, out, resume, cache, threads=None):
    words = [binary, *map(str, WORKS[name]), "--out", str(out)]
    if name != "pack" and resume:
        words.append("--resume")
    if name == "pack" and resume:
        words.append("--force")
    if threads and name in ("track", "rig"):
        words += ["--threads", str(threads)]
    return words, {"TRACKBED_CACHE": str(cache), "PATH": "/usr/bin:/bin"}


def perform(name, out, resume, cache, threads=None):
    words, environment = command(name, out, resume, cache, threads)
    return subprocess.run(words, env=environment, capture_output=True, text=True)


def content(out):
    files = (path for path in out.rglob("*") if path.is_file())
    kept = {path.relative_to(out): path.read_bytes() for path in files if path.name not in CHANGING}
    return {path: data for path, data in kept.items() if not str(path).startswith(".")}


def newest(out):
    times = [0]
    for path in out.rglob("*") if out.exists() else []:
        try:
            times.append(path.stat().st_mtime_ns)
        except FileNotFoundError:  # the program has renamed it meanwhile
            pass
    return max(times)


def kill_one(name, out, cache, resume, usual):
    """Starts the work and kills it; true where it ended before."""
    words, environment = command(name, out, resume, cache)
    process = subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline, at_write, known = time.time() + random.uniform(0, 1.1 * usual), random.random() < 0.5, newest(out)
    while process.poll() is None and time.time() < deadline:
        if at_write and newest(out) != known:
            known = newest(out)
            if random.random() < 0.2:
                break
        time.sleep(0.0005)
    ended = process.poll() is not None
    process.kill()
    process.wait()
    return ended


def references():
    found = {}
    for name in WORKS:
        out, cache = folder / f"reference_{name}", folder / "cache"
        started = time.time()
        done = perform(name, out, False, cache)
        # expectations of a shortened scene may be missed, which is an exit code of 1 and no failure
        assert (out / "report.html").exists() or name in ("pack", "study") and done.returncode == 0, done.stderr
        first = time.time() - started
        again = folder / f"again_{name}"
        started = time.time()
        assert perform(name, again, False, cache, threads=1).returncode == done.returncode
        found[name] = (content(out), min(first, time.time() - started), done.returncode)
        print(f"{name}: {found[name][1]:.2f} s, {len(found[name][0])} files, one core and two alike: {content(again) == found[name][0]}")
    return found


def attack(found):
    wrong, interrupted = 0, 0
    for number in range(kills):
        name = random.choice(list(WORKS))
        reference, usual, code = found[name]
        out = folder / "killed"
        shutil.rmtree(out, ignore_errors=True)
        # half of the beds are packed anew, so that packing is killed too
        cache = folder / "cache" if name == "study" or random.random() < 0.7 else folder / "killed_cache"
        for attempt in range(3):
            interrupted += not kill_one(name, out, cache, attempt > 0, usual)
        done = perform(name, out, True, cache)
        if done.returncode != code or content(out) != reference:
            differs = [str(path) for path in content(out).keys() | reference.keys() if content(out).get(path) != reference.get(path)]
            print(f"kill {number} of {name}: exit {done.returncode}, {differs}\n{done.stderr[-600:]}")
            wrong += 1
        if number % 10 == 0:
            shutil.rmtree(folder / "killed_cache", ignore_errors=True)
    print(f"{kills} works killed, {interrupted} times before their end: {wrong} wrong")
    return wrong


def harm(path):
    data = bytearray(path.read_bytes())
    way = random.choice(["bit", "bit", "bit", "cut", "empty", "gone"])
    if way == "bit" and data:
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        path.write_bytes(data)
    elif way == "cut":
        path.write_bytes(data[: len(data) // 2])
    elif way == "empty":
        path.write_bytes(b"")
    else:
        way = "gone"
        path.unlink()
    return way


def damage(found):
    wrong = 0
    for number in range(damages):
        name = random.choice(["track", "rig", "study", "bed"])
        out, cache = folder / "damaged", folder / "damaged_cache"
        shutil.rmtree(out, ignore_errors=True)
        shutil.rmtree(cache, ignore_errors=True)
        shutil.copytree(folder / "cache", cache)
        work = "rig" if name == "bed" else name
        finished = random.random() < 0.5
        if name == "bed":
            files = [path for path in cache.rglob("*") if path.is_file() and path.suffix != ".lock"]
        else:
            if finished:
                shutil.copytree(folder / f"reference_{name}", out)
            else:
                for _ in range(20):
                    shutil.rmtree(out, ignore_errors=True)
                    if not kill_one(name, out, cache, False, found[name][1]) and (out / ".trackbed/checkpoint").exists():
                        break
            files = [path for path in out.rglob("*") if path.is_file() and path.name not in CHANGING | {"lock"}]
        if not files:
            continue
        path = random.choice(files)
        way = harm(path)
        done = perform(work, out, name != "bed", cache)
        told = path.name in done.stderr or path.parent.name in done.stderr
        same = done.returncode == found[work][2] and content(out) == found[work][0]
        panicked = "panicked" in done.stderr
        if panicked or not (same or done.returncode != 0 and told):
            print(f"damage {number}: {way} of {path.relative_to(folder)}: exit {done.returncode}, same {same}\n{done.stderr[-400:]}")
            wrong += 1
    print(f"{damages} files damaged: {wrong} neither told nor harmless")
    return wrong


def small_study():
    """Three points of the shipped study, beside the scene that it takes its track from."""
    text = (here / "scenarios/study_pads.track").read_text()
    text = re.sub(r"(stiff.pad.stiffness: )\[[^]]*\]", r"\1[10, 40, 120]", text)
    (folder / "study.track").write_text(text)
    shutil.copy(here / "scenarios/transition.track", folder)


shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
small_study()
known = references()
sys.exit(1 if attack(known) + damage(known) else 0)
