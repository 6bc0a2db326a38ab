"""The folder of compiled pipelines: content addressed, safe between processes, bounded.

An entry is a shared object, named by key and its own checksum, and a JSON file `KEY.json` that names it. The JSON is renamed into
place last, so that whoever sees it sees a whole entry. Every file holds or has a checksum; what does not fit it is told through `warn`
and treated as absent, so that it is made anew and never loaded.
Besides, a *source key* (what can be known of a compile without running the compiler's front end) may point at an entry.
Nothing here raises for a folder that cannot be written: it says so once through `warn` and the compile goes on without a cache.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from optixc.signed_json import Json, signed, unsigned

DEFAULT_MAX_SIZE = 1 << 30

Produce = Callable[[Path], None]


@dataclass(frozen=True)
class Entry:
    """A compiled pipeline on disk and what was said about it when it was made."""

    library: Path
    manifest: Json
    hit: bool


def default_folder() -> Path:
    """OPTIXC_CACHE_DIR, else `optixc` in the user's cache folder."""
    chosen = os.environ.get("OPTIXC_CACHE_DIR")
    if chosen:
        return Path(os.path.expanduser(chosen))
    root = os.environ.get("XDG_CACHE_HOME")
    return Path(root) / "optixc" if root else Path(os.path.expanduser("~")) / ".cache" / "optixc"


def max_size() -> int:
    """OPTIXC_CACHE_MAXSIZE in bytes, 0 for no cache; anything that is not such a number is ignored."""
    text = os.environ.get("OPTIXC_CACHE_MAXSIZE", "").strip()
    return int(text) if text.isascii() and text.isdigit() else DEFAULT_MAX_SIZE


class Cache:
    """One cache folder. `warn` gets each complaint once."""

    def __init__(self, folder: Path | None, warn: Callable[[str], None], limit: int | None = None) -> None:
        self.folder = (folder or default_folder()).absolute()
        self.limit = max_size() if limit is None else limit
        self.low = self.limit // 2
        self.is_forced_off = self.limit == 0
        self.is_on = not self.is_forced_off
        self._warn = warn
        self._warned = False
        self._loose: list[tempfile.TemporaryDirectory[str]] = []

    @property
    def enabled(self) -> bool:
        return self.is_on and not self.is_forced_off

    @property
    def collects(self) -> bool:
        """Whether entries are ever dropped."""
        return self.limit > 0 and self.low > 0

    def switch_on(self) -> None:
        """Uses the folder from now on, unless the environment forbids it. Raises OSError if nothing can be written there."""
        if self.is_forced_off:
            return
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=self.folder, prefix="new-"):
                self.is_on = True
        except OSError:
            self.is_on = False
            raise

    def set_sizes(self, low: int, high: int) -> None:
        """Water marks in bytes: above `high` the oldest entries go until `low` is reached; a zero for either keeps everything."""
        if not self.is_forced_off:
            self.low, self.limit = low, high

    @property
    def memory(self) -> Path | None:
        """Where small facts may be kept between processes, None without a cache."""
        return self.folder if self.enabled else None

    def find(self, key: str) -> Entry | None:
        """The entry of this key if it is there and whole."""
        if not self.enabled:
            return None
        path = self.folder / f"{key}.json"
        record = self._read_signed(path, key)
        if record is None:
            return None
        library = self.folder / record["library"]
        try:
            checksum = _checksum(library)
        except OSError:
            # Another process has dropped the entry meanwhile.
            return None
        if checksum != record["checksum"]:
            self._drop_damaged(library)
            return None
        self._touch(path)
        return Entry(library, record["manifest"], hit=True)

    def store(self, key: str, manifest: Json, produce: Produce) -> Entry:
        """Lets `produce` write the shared object, keeps it under `key` and gives the entry; without a cache, a temporary one."""
        if self.enabled:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                with tempfile.TemporaryDirectory(prefix="new-", dir=self.folder) as scratch:
                    return self._keep(key, manifest, produce, Path(scratch))
            except OSError as error:
                self._complain(error)
        loose = tempfile.TemporaryDirectory(prefix="optixc-")
        self._loose.append(loose)
        library = Path(loose.name) / f"{key}.so"
        produce(library)
        return Entry(library, manifest, hit=False)

    def read_note(self, key: str) -> Json | None:
        """The JSON kept under a source key."""
        if not self.enabled:
            return None
        path = self.folder / f"{key}.note"
        note = self._read_signed(path, key)
        if note is not None:
            self._touch(path)
        return note

    def write_note(self, key: str, note: Json) -> None:
        """Keeps JSON under a source key."""
        if self.enabled:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                self._put_signed(self.folder / f"{key}.note", key, note)
            except OSError as error:
                self._complain(error)

    def _keep(self, key: str, manifest: Json, produce: Produce, scratch: Path) -> Entry:
        made = scratch / f"{key}.so"
        produce(made)
        size = made.stat().st_size
        if self.collects and size > self.limit:
            self._say(f"a compiled pipeline of {size} bytes is larger than the cache limit of {self.limit} and is not kept")
            loose = tempfile.TemporaryDirectory(prefix="optixc-")
            self._loose.append(loose)
            library = Path(loose.name) / made.name
            library.write_bytes(made.read_bytes())
            return Entry(library, manifest, hit=False)
        self._evict(size)
        checksum = _checksum(made)
        library = self.folder / f"{key}-{checksum[:16]}.so"
        os.replace(made, library)
        record = {"library": library.name, "checksum": checksum, "manifest": manifest}
        self._put_signed(self.folder / f"{key}.json", key, record)
        for extra in scratch.iterdir():
            os.replace(extra, self.folder / extra.name)
        return Entry(library, manifest, hit=False)

    def _read_signed(self, path: Path, key: str) -> Json | None:
        """What `_put_signed` wrote under this key, None if it is not there or not what was written."""
        try:
            data = path.read_bytes()
        except OSError:
            return None
        content = unsigned(key, data)
        if content is None:
            self._drop_damaged(path)
        return content

    def _drop_damaged(self, path: Path) -> None:
        """Says so, and takes the file away so that it is said once; one that cannot be taken away is made anew each time."""
        self._warn(f"the cache file {path} is damaged; it is not used, and what it held is compiled again")
        with suppress(OSError):
            path.unlink()

    def _put_signed(self, path: Path, key: str, content: Json) -> None:
        with tempfile.NamedTemporaryFile(dir=self.folder, prefix="new-", delete=False) as file:
            file.write(signed(key, content))
        os.replace(file.name, path)

    def _evict(self, incoming: int) -> None:
        """Makes room: above the limit the entries unused for longest go, until half of the limit is free of them."""
        files = []
        for item in os.scandir(self.folder):
            if item.is_file(follow_symlinks=False) and item.name != "compilers.json":
                status = item.stat(follow_symlinks=False)
                files.append((item.name.split("-")[0].split(".")[0], status.st_mtime_ns, status.st_size, item.path))
        total = sum(size for _, _, size, _ in files)
        if not self.collects or total + incoming <= self.limit:
            return
        last_use: dict[str, int] = {}
        for key, used, _, _ in files:
            last_use[key] = max(used, last_use.get(key, 0))
        goal = max(self.low - incoming, 0)
        for key in sorted(last_use, key=lambda key: last_use[key]):
            if total <= goal:
                return
            for _, _, size, path in (file for file in files if file[0] == key):
                Path(path).unlink(missing_ok=True)
                total -= size

    def _touch(self, path: Path) -> None:
        try:
            os.utime(path)
        except OSError:
            # A folder that may only be read still serves hits; only its order of use is lost.
            return

    def _complain(self, error: OSError) -> None:
        self._say(
            f"the cache folder {self.folder} cannot be written ({error.strerror or error}); every start compiles anew. "
            "Set OPTIXC_CACHE_DIR or cache_dir= to a folder of your own, or OPTIXC_CACHE_MAXSIZE=0 to do without"
        )

    def _say(self, message: str) -> None:
        if not self._warned:
            self._warned = True
            self._warn(message)


def _checksum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
