"""Counts the instructions of the fluid's outer step with callgrind and holds them against a ceiling.

    instructions.py PROGRAM CEILING

Instructions are the same on a busy machine as on an idle one, so a slower step shows at once where
times would not tell it from noise. Exit code 77 says that nothing could be counted here: valgrind is
missing, or does not know this processor's instructions.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, ceiling = sys.argv[1], float(sys.argv[2])
if not shutil.which("valgrind"):
    print("valgrind is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    counts = pathlib.Path(folder) / "counts"
    run = subprocess.run(
        ["valgrind", "--tool=callgrind", "--collect-atstart=no",
         "--toggle-collect=duet::fluid::Fluid::advance(double*", f"--callgrind-out-file={counts}", program],
        capture_output=True, text=True)
    if "unrecognised instruction" in run.stderr or "SIGILL" in run.stderr:
        print("valgrind does not know this processor's instructions")
        sys.exit(77)
    run.check_returncode()
    instructions = int(re.search(r"^(?:summary|totals): (\d+)", counts.read_text(), re.M).group(1))
each = instructions / int(run.stdout)
print(f"{each:.0f} instructions a particle step, ceiling {ceiling:.0f}")
sys.exit(0 if 0 < each <= ceiling else 1)
