"""The demonstration: ambient occlusion and Whitted's spheres at 1024 x 1024, with what they took. `make demo` runs it.

Each scene is rendered in a process of its own, so that the peak memory is its own.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent
SCENES_DIR = Path(os.environ.get("OXRT_SCENES_DIR", EXAMPLES.parent / ".." / "shared" / "scenes"))


def scenes() -> list[str]:
    """The courtyard always; the cathedral and the atrium where their folder is."""
    return ["courtyard", *(name for name in ("sibenik", "sponza") if (SCENES_DIR / f"{name}.npz").is_file())]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=1024, help="width and height in pixels")
    parser.add_argument("--output", type=Path, default=EXAMPLES.parent / "build" / "demo", help="folder of the pictures")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)

    commands = [
        [EXAMPLES / "04_ambient_occlusion" / "host.py", scene, "--output", arguments.output / f"ambient_occlusion_{scene}.png"]
        for scene in scenes()
    ]
    commands.append([EXAMPLES / "05_whitted_spheres" / "host.py", "--output", arguments.output / "whitted_spheres.png"])
    for command in commands:
        status = subprocess.run([sys.executable, *command, "--size", str(arguments.size)], check=False).returncode
        if status != 0:
            return status
    print(f"pictures are in {arguments.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
