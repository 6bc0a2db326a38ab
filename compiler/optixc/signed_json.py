"""Checksums of parts, and JSON text that carries one over itself and its key, so that damage of any kind is noticed."""

from __future__ import annotations

import hashlib
import json
from typing import Any

Json = dict[str, Any]
_KEY_LENGTH = 40


def digest(*parts: str | bytes) -> str:
    """A key for parts, which are kept apart from each other."""
    state = hashlib.sha256()
    for part in parts:
        # Paths may hold bytes that are no text.
        data = part.encode(errors="surrogateescape") if isinstance(part, str) else part
        state.update(len(data).to_bytes(8, "little"))
        state.update(data)
    return state.hexdigest()[:_KEY_LENGTH]


def signed(key: str, content: Json) -> bytes:
    """JSON text with a checksum over itself and its key."""
    text = json.dumps(content)
    return f"{digest(key, text)} {text}".encode()


def unsigned(key: str, data: bytes) -> Json | None:
    """The content of `signed` under the same key; None for anything else."""
    checksum, _, text = data.partition(b" ")
    if checksum != digest(key, text).encode():
        return None
    content = json.loads(text)
    return content if isinstance(content, dict) else None
