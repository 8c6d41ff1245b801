#!/usr/bin/env python3
"""Writes lists.txt: what `check` says of the lists of collision libraries, each called as its users do, over twenty
scenes, and of lists that are damaged on purpose.

Usage: record.py [BUILD]; BUILD is the build folder, by default build/release. A program of this folder makes each list,
which is checked by itself, so that no scene is reduced.
"""

import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import textwrap

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
CUBE = str(ROOT / "experiments/configs/peers/cube.off")
RUNS = 11  # of each check, for its time
LIBRARIES = ["fcl", "bullet", "ode", "embree", "cgal"]
BOXES = [  # name, arguments of `aabblab scene`
    ("brownian", "brownian --displacement 0.05"),
    ("clustered", "clustered"),
    ("far", "far --distance 10000"),
    ("flat", "flat"),
    ("hollow_sphere", "hollow_sphere"),
    ("lattice", "lattice"),
    ("line", "line"),
    ("mixed_sizes", "mixed_sizes"),
    ("needles", "needles"),
    ("one_huge", "one_huge"),
    ("pile", "pile"),
    ("population", "population"),
    ("still", "still"),
    ("teleport", "teleport"),
]
MESHES = [  # name, two meshes
    ("sphere, knot", "icosphere:triangles=2000", "torus_knot:triangles=2000"),
    ("sphere, bumps", "icosphere:triangles=2000", "noise_sphere:triangles=2000"),
    ("knot, bumps", "torus_knot:triangles=2000", "noise_sphere:triangles=2000"),
    ("sphere, itself", "icosphere:triangles=320", "icosphere:triangles=320"),
    ("square, sphere", "square:triangles=200", "icosphere:triangles=320"),
    ("cube, itself", CUBE, CUBE),
]
HEAD = """\
What `check` says of the lists of collision libraries, each called as its users
do: {versions}.
fn and fp are false negatives and false positives. The time is that of the check
over that of the search, without reading the list, each the least of 11 runs.
To make this file again: experiments/checking/libraries/record.py
"""


def run(*arguments):
    """Runs a program, which may end with status 1, and returns what it prints."""
    ended = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=False)
    if ended.returncode not in (0, 1):
        sys.exit(f"{' '.join(map(str, arguments))}: {ended.stderr or ended.returncode}")
    return ended.stdout


def lines_of(begin, report):
    """The numbers of a report after the begin of its line, its classes, and below them what `check` says."""
    words = [f"{name} {sum(counts):,}" for name, counts in report["classes"].items() if sum(counts)]
    for key in ("unclassified", "duplicates", "self_pairs", "unknown_ids", "unknown_frames"):
        if report[key]:
            words.append(f"{report[key]:,} {key.replace('_', ' ')}")
    begin += f"{report['false_negatives']:>8,}{report['false_positives']:>10,}{report['time']:>7.2f}  "
    said = "The list is right." if report["right"] else "; ".join(words)
    lines = textwrap.wrap(said, 80, initial_indent=begin, subsequent_indent=" " * len(begin))
    for sentence in report["patterns"]:
        lines += textwrap.wrap(sentence, 80, initial_indent=" " * 8, subsequent_indent=" " * 8)
    return lines


class Recorder:
    """Runs the programs of a build in a temporary folder."""

    def __init__(self, build, work):
        self.program = build / "aabblab"
        self.work = work
        made = {name: build / f"experiments/checking/libraries/list_of_{name}" for name in LIBRARIES}
        self.makers = {name: maker for name, maker in made.items() if maker.exists()}

    def versions(self):
        return ", ".join(run(maker, "--version").strip() for maker in self.makers.values())

    def check(self, inputs, pairs):
        """The report on a list, with its time: the least of several runs, over the least of their searches."""
        reports = [json.loads(run(self.program, "check", *inputs, pairs, "--json")) for _ in range(RUNS)]
        reports[0]["time"] = min(r["check_ms"] for r in reports) / min(r["search_ms"] for r in reports)
        return reports[0]

    def libraries(self, scene, inputs):
        """The lines of a scene: a list of each library."""
        lines = []
        for name, maker in self.makers.items():
            made = self.work / "made.csv"
            run(maker, *inputs, made)
            report = self.check(inputs, made)
            begin = f"{scene:<15}{report['pairs']:>9,} " if not lines else " " * 25
            lines += lines_of(f"{begin}{name:<7}", report)
        return lines

    def all_libraries(self):
        lines = [f"{'scene':<15}{'pairs':>9} {'library':<7}{'fn':>8}{'fp':>10}{'time':>7}  classes"]
        for name, scene in BOXES:
            recording = self.work / "scene.aabbs"
            run(self.program, "scene", *scene.split(), "--n", 1000, "--frames", 10, "--out", recording)
            lines += self.libraries(name, [recording])
        for name, *meshes in MESHES:
            files = [self.work / "a.off", self.work / "b.off"]
            for mesh, file in zip(meshes, files):
                run(self.program, "order", mesh, "--out", file)
            lines += self.libraries(name, files)
        return lines

    def damaged(self, name, scene, rows):
        """The lines of a damaged list."""
        damaged = self.work / "damaged.csv"
        damaged.write_text("".join(f"{frame},{a},{b}\n" for frame, a, b in rows))
        return lines_of(f"{name:<26}", self.check([scene], damaged))

    def all_damages(self):
        scene = self.work / "drifting.aabbs"
        run(self.program, "scene", "brownian", "--n", 10000, "--frames", 10, "--out", scene)
        frames = boxes_of(scene)
        right = [(frame, a, b) for frame, boxes in enumerate(frames) for a, b in overlaps(boxes)]
        lines = [f"Damaged lists of 10,000 drifting cubes in 11 frames, with {len(right):,} pairs", ""]
        lines += [f"{'damage':<26}{'fn':>8}{'fp':>10}{'time':>7}  classes"]
        for name, rows in damages_of(right, frames):
            lines += self.damaged(name, scene, rows)
        return lines + self.dropped_touching() + self.rounded()

    def dropped_touching(self):
        """Boxes with whole coordinates; many of them touch."""
        random.seed(1)
        boxes = []
        for _ in range(2000):
            least = [random.randrange(30) for _ in range(3)]
            boxes.append((least, [x + random.randrange(1, 3) for x in least]))
        scene = self.write_boxes(boxes)
        deep = [(0, a, b) for a, b in overlaps(boxes, is_open=True)]
        return self.damaged("touching pairs dropped", scene, deep)

    def rounded(self):
        """Boxes in double that touch, but for a billionth, and the list of the boxes in float."""
        random.seed(2)
        boxes = []
        for _ in range(2000):
            least = [random.randrange(30) + random.choice((-1e-9, 0, 1e-9)) for _ in range(3)]
            boxes.append((least, [x + 1 for x in least]))
        scene = self.write_boxes(boxes)
        in_float = [tuple([struct.unpack("f", struct.pack("f", x))[0] for x in end] for end in box) for box in boxes]
        return self.damaged("boxes rounded to float", scene, [(0, a, b) for a, b in overlaps(in_float)])

    def write_boxes(self, boxes):
        file = self.work / "boxes.csv"
        file.write_text("".join(",".join(repr(x) for x in (*least, *greatest)) + "\n" for least, greatest in boxes))
        return file


def boxes_of(recording):
    """The boxes of a recording, by frame and object."""
    data = recording.read_bytes()
    objects, last = struct.unpack_from("<2i", data, 256)
    numbers = struct.iter_unpack("<8f", data[304:])
    return [[(n[0:3], n[4:7]) for _, n in zip(range(objects), numbers)] for _ in range(last + 1)]


def overlaps(boxes, axes=(0, 1, 2), is_open=False):
    """All pairs of boxes that overlap on these axes, by a sweep along x."""
    order = sorted(range(len(boxes)), key=lambda i: boxes[i][0][0])
    active = []
    for i in order:
        least, greatest = boxes[i]
        active = [j for j in active if boxes[j][1][0] >= least[0]]
        for j in active:
            other_least, other_greatest = boxes[j]
            if is_open:
                hit = all(least[k] < other_greatest[k] and other_least[k] < greatest[k] for k in axes)
            else:
                hit = all(least[k] <= other_greatest[k] and other_least[k] <= greatest[k] for k in axes)
            if hit:
                yield min(i, j), max(i, j)
        active.append(i)


def damages_of(right, frames):
    """Names of damages, each with the list."""
    last = len(frames[0]) - 1
    lost = right[len(right) // 2][1]
    exchanged = {right[0][1]: last, last: right[0][1]}
    yield "none", right
    yield "ids in the other order", [(frame, b, a) for frame, a, b in reversed(right)]
    yield "ids from 1", [(frame, a + 1, b + 1) for frame, a, b in right]
    yield "ids mirrored", [(frame, last - a, last - b) for frame, a, b in right]
    yield "two ids exchanged", [(frame, exchanged.get(a, a), exchanged.get(b, b)) for frame, a, b in right]
    yield "every pair twice", right + [(frame, b, a) for frame, a, b in right]
    yield "self pairs added", right + [(frame, i, i) for frame in range(len(frames)) for i in range(last + 1)]
    yield "list of frame 5 kept", [r for r in right if r[0] <= 5] + [
        (frame, a, b) for frame in range(6, len(frames)) for of, a, b in right if of == 5
    ]
    yield "frames from 1", [(frame + 1, a, b) for frame, a, b in right]
    yield "one frame late", [r for r in right if r[0] == 0] + [(f + 1, a, b) for f, a, b in right if f + 1 < len(frames)]
    yield "frame 5 missing", [r for r in right if r[0] != 5]
    yield "one object lost", [r for r in right if lost not in r[1:]]
    yield "z not tested", [(frame, a, b) for frame, boxes in enumerate(frames) for a, b in overlaps(boxes, (0, 1))]


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release").resolve()
    with tempfile.TemporaryDirectory() as folder:
        recorder = Recorder(build, pathlib.Path(folder))
        lines = HEAD.format(versions=recorder.versions()).splitlines() + [""]
        lines += recorder.all_libraries() + [""] + recorder.all_damages()
    (HERE / "lists.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
