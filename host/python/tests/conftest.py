"""What the tests share."""

from __future__ import annotations

from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]


@pytest.fixture
def scenes() -> Path:
    """The folder of the bundled scenes."""
    return REPOSITORY / "scenes"
