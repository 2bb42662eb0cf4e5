"""Where the files that belong to the product lie: in a wheel, or in a checkout.

A wheel carries them under ``agent_server/assets``; in a checkout they are where they are made.
"""

from pathlib import Path

_PACKAGE = Path(__file__).parent
_PACKAGED = _PACKAGE / "assets"
_CHECKOUT = _PACKAGE.parent


def _choose(packaged: str, checkout: Path) -> Path:
    path = _PACKAGED / packaged
    return path if path.exists() else checkout


def bundles() -> Path:
    """Folder of the model bundles that ship."""
    return _choose("bundles", _CHECKOUT / "models" / "artifacts")


def page() -> Path:
    """Folder of the built browser page; it may not exist in a checkout that never built it."""
    return _choose("page", _PACKAGE / "web" / "dist")


def checkout() -> Path | None:
    """Root of the checkout that this runs from, or None for an installed wheel."""
    return _CHECKOUT if (_CHECKOUT / "pyproject.toml").is_file() else None


def demo_recording() -> Path:
    """The recording that the demo plays."""
    return streams() / "demo.mcap"


def streams() -> Path:
    """Folder of the recordings that ship."""
    return _choose("streams", _CHECKOUT / "recorded_streams")
