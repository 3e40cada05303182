"""Shared by the tests."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]

# A background job of a shell inherits an ignored SIGINT. Tests of Ctrl-C, here or in a child, would then wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def scenes() -> Path:
    """The folder of the bundled scenes."""
    return REPOSITORY / "scenes"
