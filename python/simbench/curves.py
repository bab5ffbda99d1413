"""Curves over tau: deviations and MTIE, of simulated and of measured clocks."""

from __future__ import annotations

import math
from typing import Any, Dict, Mapping, Sequence

from .errors import InputError
from .tables import needed

#: Those with a confidence interval.
DEVIATIONS = ("adev", "mdev", "hdev", "tdev_ms")
CURVES = (*DEVIATIONS, "mtie_ms")

#: The points of a curve: tau_s, value, and where it is known its interval low and high.
Points = Sequence[Mapping[str, Any]]


class HasCurves:
    """What has a curve for each measure: its curves by their names."""

    def curve(self, measure: str) -> Any:
        """The points of a curve, `measure`: one of CURVES."""
        raise NotImplementedError

    @property
    def adev(self) -> Any:
        """The overlapping Allan deviation, without a unit."""
        return self.curve("adev")

    @property
    def mdev(self) -> Any:
        """The modified Allan deviation, without a unit."""
        return self.curve("mdev")

    @property
    def hdev(self) -> Any:
        """The overlapping Hadamard deviation, without a unit."""
        return self.curve("hdev")

    @property
    def tdev_ms(self) -> Any:
        """The time deviation in ms."""
        return self.curve("tdev_ms")

    @property
    def mtie_ms(self) -> Any:
        """The maximum time interval error in ms, which has no interval."""
        return self.curve("mtie_ms")


def check_measure(measure: str) -> None:
    """Raises InputError."""
    if measure not in CURVES:
        raise InputError(f"measure: found {measure!r}, allowed: {', '.join(CURVES)}")


def draw(curves: Mapping[str, Points], measure: str, ax: Any) -> Any:
    """Draws a line for each name, on logarithmic axes, with its interval. Returns the axes."""
    pyplot = needed("matplotlib.pyplot", "plot()")
    check_measure(measure)
    if ax is None:
        _, ax = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for name, points in curves.items():
        drawn = [point for point in points if point["value"] is not None]
        (line,) = ax.plot([point["tau_s"] for point in drawn], [point["value"] for point in drawn],
                          "o-", label=name)
        sure = [point for point in drawn if point.get("low") is not None]
        ax.fill_between([point["tau_s"] for point in sure], [point["low"] for point in sure],
                        [point["high"] for point in sure], color=line.get_color(), alpha=0.2, lw=0)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("tau, s")
    ax.set_ylabel(f"{measure[:-3].upper()}, ms" if measure.endswith("_ms") else measure.upper())
    ax.grid(True, alpha=0.3)
    ax.legend(fontsize="small")
    return ax


def dataset(of: str, curves: Mapping[str, Mapping[str, Points]], with_interval: bool) -> Any:
    """An xarray.Dataset of the shape (`of`, tau_s). curves: by measure, then by name; with_interval:
    with variables of low and high."""
    xarray = needed("xarray", "to_xarray()")
    names = list(dict.fromkeys(name for each in curves.values() for name in each))
    taus = sorted({point["tau_s"] for each in curves.values() for points in each.values()
                   for point in points})
    variables: Dict[str, Any] = {}
    for measure, each in curves.items():
        unit = {"units": "ms"} if measure.endswith("_ms") else {}
        has_interval = with_interval and measure in DEVIATIONS
        for member in ("value", "low", "high") if has_interval else ("value",):
            values = [[math.nan] * len(taus) for _ in names]
            for row, name in enumerate(names):
                for point in each.get(name, ()):
                    if point[member] is not None:
                        values[row][taus.index(point["tau_s"])] = point[member]
            label = measure if member == "value" else f"{measure}_{member}"
            variables[label] = ((of, "tau_s"), values, unit)
    return xarray.Dataset(variables, coords={of: names, "tau_s": ("tau_s", taus, {"units": "s"})})
