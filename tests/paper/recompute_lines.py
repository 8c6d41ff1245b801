"""The points of a figure, recomputed or drawn, and how both differ."""

import csv
import math


class Lines(dict):
    """The points of a figure by panel and series: dictionaries of x, y and, where they vary, limits."""

    def add(self, series, points, panel=""):
        if points:
            self.setdefault((panel, series), []).extend(points)


def drawn(file):
    """The points of figures/NAME.csv."""
    lines = Lines()
    with open(file, newline="", encoding="utf-8") as text:
        for row in csv.DictReader(text):
            lines.add(row["series"], [row], row.get("panel") or "")
    return lines


def same(mine, theirs):
    return math.isclose(mine, float(theirs), rel_tol=1e-6, abs_tol=1e-12)


def differences_of(name, mine, theirs):
    """A sentence per series that differs."""
    found = []
    for key in dict.fromkeys([*mine, *theirs]):
        where = f"{name}: {' '.join(filter(None, key))}"
        if key not in mine or key not in theirs:
            found.append(f"{where} is {'not ' if key in mine else 'only '}drawn")
            continue
        if len(mine[key]) != len(theirs[key]):
            found.append(f"{where} has {len(mine[key])} points, not {len(theirs[key])}")
            continue
        for point, row in zip(mine[key], theirs[key]):
            full = {"low": point["y"], "high": point["y"], **point}
            if "x" in point and row.get("x_low"):
                full = {"x_low": point["x"], "x_high": point["x"], **full}
            elif full.get("x_low") == full.get("x_high"):  # the figure has no interval of any x
                full.pop("x_low", None)
                full.pop("x_high", None)
            wrong = [f"{k} is {v:.6g}, not {row.get(k)}" for k, v in full.items() if not row.get(k) or not same(v, row[k])]
            if wrong:
                found.append(f"{where}: {', '.join(wrong)}")
                break
    return found
