"""The error of an identification."""

from odometry.errors import OdometryError


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
