# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What is measured on fields of `damage` in two dimensions: how many cracks, how long, where they turn, branch and how fast they run."""

import csv
import json
import math
import os

import h5py
import numpy as np

SHOWN = 0.35  # damage of a node beside a straight crack: nearly a half; at its end less


class Result:
    """The results of one model in a folder."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        self.name, self.model = next(iter(self.summary["models"].items()))

    def times(self):
        return [entry["time"] for entry in self.summary["fields"]]

    def damage(self, entry=-1):
        """Coordinates along both axes of a plate's nodes and a table of their damage (cells at a vertex write it more than once)."""
        nodes, values = nodes_and_damage(self, entry)
        axes, places = zip(*(np.unique(np.round(nodes[:, d], 9), return_inverse=True) for d in range(2)))
        table = np.zeros([len(axis) for axis in axes])
        table[places] = values
        return (*axes, table)

    def history(self, *quantities):
        """Rows (time, value of each quantity) of totals.csv."""
        times = {}
        with open(os.path.join(self.folder, "totals.csv"), newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["model"] == self.name:
                    times.setdefault(float(row["time"]), {})[row["quantity"]] = float(row["value"])
        return [(t, *(times[t][q] for q in quantities)) for t in sorted(times)]


def nodes_and_damage(result, entry=-1):
    """All nodes and their damage, in any dimension."""
    with h5py.File(os.path.join(result.folder, result.summary["fields"][entry]["files"][result.name])) as file:
        return file["nodes"][:], file["damage"][:].ravel()


def sides_of_beam(nodes, values):
    """Of a beam along x: coordinates x and tables [row, x] of a value at the nodes of its front (z largest, from above), bottom (from the front) and back side (from below)."""
    axes, places = zip(*(np.unique(np.round(nodes[:, d], 9), return_inverse=True) for d in range(3)))
    table = np.zeros([len(axis) for axis in axes])
    table[places] = values
    front, bottom, back = table[:, ::-1, -1].T, table[:, 0, ::-1].T, table[:, :, 0].T
    return axes, (front, bottom, back)


def angle_in_layer(nodes, damage, y, within=0.025):
    """Angle to x, in degrees, of the straight line (total least squares) through the damaged nodes nearer than `within` to z = 0 in the layer nearest to y; nan where there are few."""
    layer = abs(nodes[:, 1] - y) < abs(nodes[:, 1] - y).min() + 1e-9
    points = np.unique(np.round(nodes[layer & (damage > 0.3) & (abs(nodes[:, 2]) < within)][:, [0, 2]], 9), axis=0)
    if len(points) < 4:
        return math.nan
    along = np.linalg.svd(points - points.mean(0))[2][0]
    return math.degrees(math.atan(along[1] / along[0]))


def stretches(row):
    """First and last index of each stretch of True in a row."""
    edges = np.diff(np.concatenate([[0], row.astype(int), [0]]))
    return list(zip(np.where(edges == 1)[0], np.where(edges == -1)[0] - 1))


def cracks_at(axis, depths, table, depth, shown=0.25):
    """How many cracks from the side depths[0] reach a depth."""
    return len(stretches(table[:, np.argmin(abs(depths - depth))] > shown))


def direction(x, y, table, tip, side, clear=0.006):
    """Angle to x, in degrees, of the straight line (total least squares) through the damaged nodes further than `clear` beside a notch along x that ends at tip; side: 1 above, -1 below."""
    places = np.argwhere(table > SHOWN)
    beyond = (np.column_stack([x[places[:, 0]], y[places[:, 1]]]) - np.array(tip)) * np.array([1, side])
    beyond = beyond[beyond[:, 1] > clear]
    along = np.linalg.svd(beyond - beyond.mean(0))[2][0]
    return math.degrees(math.atan2(abs(along[1]), along[0] * np.sign(along[1])))


def furthest(x, y, table, tip, clear):
    """The damaged node furthest above a notch's tip; None if none is further than `clear`."""
    places = np.argwhere((table > SHOWN) & (x[:, None] > 0.6 * tip[0]) & (y[None, :] > tip[1] + clear))
    if not len(places):
        return None
    i, j = places[np.argmax(y[places[:, 1]])]
    return x[i], y[j]


def branching(x, y, table, apart, start, within):
    """Where a crack along x first is two: the first column beyond `start` with damaged nodes more than `apart` from each other and none between; None if nowhere. Nodes further than `within` from y = 0 do not count."""
    inside = abs(y) < within
    for i in np.where(x > start)[0]:
        rows = np.where((table[i] > SHOWN) & inside)[0]
        if len(rows) > 1 and np.diff(y[rows]).max() > apart:
            return x[i]
    return None


def front(x, y, table, within):
    """The furthest x of damaged nodes nearer than `within` to y = 0."""
    return x[np.where(((table > SHOWN) & (abs(y) < within)).any(1))[0][-1]]
