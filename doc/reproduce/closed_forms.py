# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Exact solutions of classical diffusion for the examples of the four papers, written down here and not taken from PeriDeal.

All take arrays of coordinates and a time, and return arrays.
"""

import numpy as np

PI = np.pi


def modes(first, step, n_terms):
    """Numbers of the terms of a series, as a column."""
    return np.arange(first, first + step * n_terms, step, dtype=float)[:, None]


# ---- Bobaru and Duangpanya 2010: bars of diffusivity 1.14 cm^2/s

def cooling_bar(x, t, length=10.0, alpha=1.14, start=100.0):
    """Example 1: equation 33 with its missing factor 1/n."""
    k = modes(1, 2, 400) * PI / length
    return 4 * start / length * np.sum(np.sin(k * x) / k * np.exp(-alpha * k * k * t), axis=0)


def cooling_bar_flux(x, t, length=10.0, kappa=1.14, start=100.0):
    """Example 1: -kappa dT/dx."""
    k = modes(1, 2, 400) * PI / length
    return -kappa * 4 * start / length * np.sum(np.cos(k * x) * np.exp(-kappa * k * k * t), axis=0)


def two_temperatures_terms(length=10.0, left=60.0, right=0.0, end=100.0):
    """Example 2: wave numbers and coefficients of equation 38, with its second minus a plus."""
    n = modes(1, 2, 400)
    a, b = np.sin(n * PI / 4), np.sin(n * PI / 2)
    return n * PI / (2 * length), 4 / (PI * n) * ((left - end) * a + (right - end) * (b - a)), end


def two_temperatures(x, t, alpha=1.14):
    """Example 2."""
    k, c, end = two_temperatures_terms()
    return end + np.sum(c * np.cos(k * x) * np.exp(-alpha * k * k * t), axis=0)


def two_temperatures_flux(x, t, kappa=1.14):
    """Example 2: -kappa dT/dx."""
    k, c, _ = two_temperatures_terms()
    return kappa * np.sum(c * k * np.sin(k * x) * np.exp(-kappa * k * k * t), axis=0)


def given_flux(x, t, alpha=1.14, value=20.0, slope=3.0):
    """Example 3 on a bar of length pi: sin(n x/2) in equation 43."""
    k = modes(1, 2, 2000) / 2
    # Coefficients of -(value + slope x) in sin(k x), whose derivative vanishes at pi.
    c = -2 / PI * (value / k + slope * np.sin(k * PI) / k**2)
    return value + slope * x + np.sum(c * np.sin(k * x) * np.exp(-alpha * k * k * t), axis=0)


# ---- Bobaru and Duangpanya 2012: unit squares

def cooling_square(x, y, t, alpha=1.14, start=40.0):
    """Example 1: a product of two bars."""
    return cooling_bar(x, t, 1.0, alpha, 1.0) * cooling_bar(y, t, 1.0, alpha, start)


def cooling_square_flux(x, y, t, alpha=1.14, start=40.0):
    """Example 1: the flux along x."""
    return cooling_bar_flux(x, t, 1.0, alpha, 1.0) * cooling_bar(y, t, 1.0, alpha, start)


def heated_side(x, t):
    """Example 2 along any line y = constant: 1 at x = 0, insulated at x = 1."""
    k = (modes(1, 1, 400) - 0.5) * PI
    return 1 - 2 * np.sum(np.sin(k * x) / k * np.exp(-k * k * t), axis=0)


# ---- Tan et al. 2020: conductivity 5 exp(lambda y), heat capacity exp(lambda y), height 1

def graded_plate(y, t, grading=3.0, alpha=5.0, top=100.0):
    """Example 1: equation 28."""
    b = grading / 2
    n = modes(1, 1, 300)
    c = 2 * top * np.exp(b) * n * PI * np.cos(n * PI) / (b * b + n * n * PI * PI)
    steady = top * (1 - np.exp(-2 * b * y)) / (1 - np.exp(-2 * b))
    return steady + np.sum(c * np.sin(n * PI * y) * np.exp(-b * y - (n * n * PI * PI + b * b) * alpha * t), axis=0)


def graded_plate_flux(y, t, grading=3.0, alpha=5.0, top=100.0):
    """Example 1: -K dT/dy; the paper plots K dT/dy."""
    b = grading / 2
    n = modes(1, 1, 300)
    c = 2 * top * np.exp(b) * n * PI * np.cos(n * PI) / (b * b + n * n * PI * PI)
    slope = top * 2 * b * np.exp(-2 * b * y) / (1 - np.exp(-2 * b))
    decay = np.exp(-b * y - (n * n * PI * PI + b * b) * alpha * t)
    slope = slope + np.sum(c * (n * PI * np.cos(n * PI * y) - b * np.sin(n * PI * y)) * decay, axis=0)
    return -alpha * np.exp(grading * y) * slope


# ---- Diyaroglu et al. 2017

def hot_ends(x, t, alpha=1.1535e-4, value=100.0):
    """Example A: a cold bar of length 1 whose ends are hot."""
    return value - cooling_bar(x, t, 1.0, alpha, value)


def thermal_shock(x, t, length=10.0):
    """Example B along any line y = constant: T(0, t) = 5 t exp(-2 t), insulated at the far end, diffusivity 1.

    T = T(0, t) + sum b_n(t) sin(k_n x), and b_n' = -k_n^2 b_n - 2/(k_n length) dT(0, t)/dt, integrated by hand.
    """
    k = (modes(1, 1, 3000) - 0.5) * PI / length
    a = k * k - 2
    history = np.exp(-2 * t) * ((1 - 2 * t) / a + 2 / a**2) - np.exp(-k * k * t) * (1 / a + 2 / a**2)
    return 5 * t * np.exp(-2 * t) - 10 / length * np.sum(np.sin(k * x) / k * history, axis=0)


def slab_weight(t, lengths=(42.0, 37.7, 1.2), diffusivity=0.01026, saturated=0.0125):
    """Example D: the weight in the whole slab; what is missing is a product of three series."""
    missing = 1.0
    for length in lengths:
        n = modes(1, 2, 4000)
        missing *= float(np.sum(8 / (n * PI)**2 * np.exp(-diffusivity * (n * PI / length)**2 * t)))
    return saturated * float(np.prod(lengths)) * (1 - missing)
