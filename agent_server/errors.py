"""The one exception tree of the product.

Errors of other libraries are translated at the edge where they are met, so that a caller
can catch :class:`AgentServerError` and nothing else.
"""


class AgentServerError(Exception):
    """Base of every error that this package raises on purpose."""


class ConfigError(AgentServerError):
    """A setting contradicts itself or is out of range; the text names it and the way out."""


class InvalidInput(AgentServerError):
    """A value from outside does not fit what was asked for.

    Args:
        message: A sentence with what was expected, what was got, and what to do.
        field: Path of the offending field, for example ``joints[3][1]``.
        code: Stable machine-readable name of the mistake, for example ``not_finite``.
    """

    def __init__(self, message: str, *, field: str | None = None, code: str = "invalid") -> None:
        super().__init__(message)
        self.field = field
        self.code = code


class RuleError(AgentServerError):
    """A rule file is wrong; the text names the line and the fix."""


class BundleError(AgentServerError):
    """A model bundle is missing, altered, or does not give its golden output."""


class InferenceError(AgentServerError):
    """A model failed while it was running."""


class RecordingError(AgentServerError):
    """A recording cannot be read or written; the text names the file."""
