#!/usr/bin/env python3
"""What tools/gpu_check says of a card that is fast, slow, full, missing or hangs: a script stands in for dreampm.

    gpu_check_test.py TOOLS_FOLDER
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

STAND_IN = r"""#!/usr/bin/python3 -SE
import json, os, sys, time
words = sys.argv[1:]
value = lambda name: words[words.index(name) + 1]
if words[:2] == ["info", "--device"]:
    found = not os.environ.get("MISSING")
    print(json.dumps({"found": found, "text": os.environ["CARD"] if found else "no CUDA: no driver", "free_bytes": 70e9}))
    sys.exit(0 if found else 1)
if words[0] == "info":
    print("{}")
    sys.exit(0)
if os.environ.get("HANGS"):
    open(os.environ["HANGS"], "w").write(str(os.getpid()))
    time.sleep(60)
if words[:2] == ["bench", "step"] and os.environ.get("BABBLES"):
    print("what?")
elif words[:2] == ["bench", "step"]:
    cells = [int(n) for n in words[words.index("--cells") + 1:][:3]] if "--cells" in words else None
    particles = 8 * cells[0] * cells[1] * cells[2] if cells else int(value("--particles"))
    mps = 110 if value("--backend") == "cpu" else float(os.environ["MPS"])
    print(json.dumps({"results": [{"particles": particles, "isa": "sm_90", "mps": mps, "spread": 0.01, "bytes_per_particle": 1,
                                   "memory_per_particle": 2, "device_memory_per_particle": 2000}]}))
elif words[0] == "run":
    folder = value("--out")
    os.makedirs(folder)
    json.dump({"particles": 1054000, "frames": [{}] * 120, "status": "complete",
               "stages": {"simulate": {"seconds": float(os.environ["DRAGON"]), "particle_steps": 1}}}, open(folder + "/run.json", "w"))
elif words[:2] == ["play", "--help"]:
    print("--frames")
"""
SANITIZER = r"""#!/usr/bin/python3 -SE
import sys
print("========= COMPUTE-SANITIZER")
tool = sys.argv[sys.argv.index("--tool") + 1]
print("========= RACECHECK SUMMARY: 1 hazard" if tool == "racecheck" else "========= ERROR SUMMARY: 0 errors")
sys.exit(9 if tool == "racecheck" else 0)
"""
failures = []


def expect(what, found, wanted):
    if found != wanted:
        failures.append(f"{what}: {found!r}, wanted {wanted!r}")


class Checked:
    def __init__(self, code, found, said):
        self.code, self.found, self.said = code, found, said

    def part(self, name):
        return next(p for p in self.found["parts"] if p["name"] == name)

    def row(self, material, asked, backend="cuda"):
        return next(r for r in self.found["speed"] if (r["material"], r["asked"], r["backend"]) == (material, asked, backend))


def check(tool, folder, *options, stop_at=None, **environment):
    out = folder / "found.json"
    out.unlink(missing_ok=True)
    process = subprocess.Popen([tool, "--dreampm", folder / "dreampm", "--out", out, *options], text=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               env={**os.environ, "CARD": "NVIDIA H100 80GB HBM3", "MPS": "8000", "DRAGON": "20", **environment})
    if stop_at:
        for _ in range(1000):
            if stop_at.exists() and stop_at.read_text():
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
    said = process.communicate(timeout=60)[1]
    return Checked(process.returncode, json.loads(out.read_text()), said)


def main():
    tool = pathlib.Path(sys.argv[1]).resolve() / "gpu_check"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for program, text in (("dreampm", STAND_IN), ("compute-sanitizer", SANITIZER)):
            (folder / program).write_text(text)
            (folder / program).chmod(0o755)
        parts = ("--only", "small", "cpu", "large", "dragon", "play", "largest")

        fast = check(tool, folder, *parts)
        expect("a fast card", (fast.code, fast.found["failed"], fast.found["finished"]), (0, [], True))
        expect("its bars", [b["holds"] for b in fast.found["bars"]], [True] * 6)
        expect("its column", fast.row("newtonian", 65536)["particles"], 65536)
        expect("its ratio", round(fast.found["ratio_to_two_cpu_threads"]["snow"], 1), 72.7)
        expect("claymore beside it", fast.row("newtonian", 8388608)["beside"]["claymore, J fluid"], 4.49)
        expect("no room", "128.0 GB of the device's memory, 70.0 are free" in fast.row("snow", 64000000)["left_out"], True)
        expect("the playground", fast.part("play")["why"], "dreampm play takes no --backend in this version")

        slow = check(tool, folder, "--only", "small", "large", "dragon", MPS="4000", DRAGON="31")
        expect("a slow card", (slow.code, slow.found["failed"], len(slow.found["missed"])), (1, [], 5))
        expect("a bar", slow.found["missed"][0], "newtonian, 1,048,576 particles: 4 G/s, wanted 6")
        other = check(tool, folder, "--only", "small", MPS="4000", CARD="NVIDIA L4")
        expect("a card without bars", (other.code, other.found["missed"]), (0, []))

        race = check(tool, folder, "--only", "sanitizer", PATH=f"{folder}:{os.environ['PATH']}")
        expect("a race", (race.code, race.found["failed"][0]),
               (1, "racecheck of all kinds of matter and surroundings: exit code 9: RACECHECK SUMMARY: 1 hazard"))
        expect("its runs", [r["code"] for r in race.found["sanitizer"]["runs"]], [9, 9, 0, 0, 0, 0])

        babble = check(tool, folder, "--only", "large", "dragon", BABBLES="1")
        expect("what is no JSON", (babble.code, babble.part("large")["state"], babble.part("dragon")["state"]),
               (1, "failed", "done"))

        missing = check(tool, folder, MISSING="1")
        expect("no card", (missing.code, missing.found["failed"]), (1, ["no device: no CUDA: no driver"]))

        hangs = check(tool, folder, "--only", "small", "--seconds", "4", HANGS=str(folder / "pid"))
        expect("a card that hangs", (hangs.code, len(hangs.found["failed"])), (1, 4))
        expect("its row", "left_out" in hangs.row("snow", 1048576), True)

        (folder / "pid").unlink()
        stopped = check(tool, folder, "--only", "large", HANGS=str(folder / "pid"), stop_at=folder / "pid")
        expect("an interrupted check", (stopped.code, stopped.found["finished"], stopped.part("large")["state"]),
               (130, False, "interrupted"))
        expect("what it began has ended", pathlib.Path("/proc/" + (folder / "pid").read_text()).exists(), False)
    print("\n".join(failures) or "ok")
    return 1 if failures else 0


sys.exit(main())
