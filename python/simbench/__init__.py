"""simbench: how well cameras on hosts over a network are synchronised, and what limits it."""

from . import _simbench

__version__: str = _simbench.version
