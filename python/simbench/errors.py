"""What simbench raises. The text is what the command line would have said."""


class Error(Exception):
    """Something failed that is not a mistake of the caller, such as a run that broke off."""


class InputError(Error, ValueError):
    """Input that is refused: a scenario, a file, a name. It says what was found and what is allowed."""


class OutputError(Error, OSError):
    """A result that cannot be written."""


class MissingPackage(Error, ImportError):
    """A package that simbench works without, but this method does not."""
