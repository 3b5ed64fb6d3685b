"""The errors of the package: one base, one child per kind of input."""


class OdometryError(Exception):
    """Base of every error that this project raises on purpose.

    Examples
    --------
    >>> import odometry
    >>> try:
    ...     odometry.read_parameters("nowhere.toml")
    ... except odometry.OdometryError as error:
    ...     print(error)
    nowhere.toml: cannot be read: No such file or directory
    """


class RunFolderError(OdometryError):
    """A run folder, or a file of one, does not have the documented format."""


class ParameterError(OdometryError):
    """A parameter set, or one of its tables, does not have the documented format."""


class ConfigError(OdometryError):
    """A configuration table holds an unknown key or a value of the wrong kind."""


class TrajectoryError(OdometryError):
    """A trajectory is malformed, or does not cover the requested time."""


class OutputError(OdometryError):
    """Results cannot be written where they are wanted."""


class ExtraError(OdometryError):
    """An optional package is needed and not installed."""


class BagError(OdometryError):
    """A bag, or a map of its topics, cannot be used as it is.

    Attributes
    ----------
    options : tuple of str
        Of the command, with what is to be put in their place: what is missing.
    """

    def __init__(self, message: str, options: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.options = options


class ExportError(OdometryError):
    """A parameter set or a result does not hold what a format needs."""


class ComparisonError(OdometryError):
    """Runs or models that cannot be compared."""


class EstimationError(OdometryError):
    """An estimate, a chain of modes or a filter is invalid."""


class IdentificationError(OdometryError):
    """Runs that do not determine what is to be identified.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> still = odometry.cut_run(run, odometry.Span(0.0, 3.0))
    >>> try:
    ...     odometry.identify([still], "icr", terrain="yard").require_determined()
    ... except odometry.IdentificationError as error:
    ...     print(str(error)[:60])
    1 windows do not determine 5 parameters of 'icr'
    """


class WindowError(OdometryError):
    """A recording that cannot be cut into the required windows."""


class SimulationError(OdometryError):
    """A drive cannot be simulated from what was given."""


class GapError(OdometryError):
    """Runs or settings from which no gap can be found."""
