#!/bin/sh
# Builds and runs the tests of liboxrt plain, under AddressSanitizer with UndefinedBehaviorSanitizer, and under ThreadSanitizer.
# Usage: tests/runtime/run.sh [plain] [address] [thread]; PYTHON names an interpreter that has embreex, CMAKE and CXX as usual.
set -e
root=$(cd "$(dirname "$0")/../.." && pwd)
python=${PYTHON:-python3}
cmake=${CMAKE:-cmake}
if [ -z "$OXRT_EMBREE" ]; then
    OXRT_EMBREE=$("$python" -c "
import glob, os, embreex
print(glob.glob(os.path.join(os.path.dirname(embreex.__file__), '..', 'embreex.libs', 'libembree4*'))[0])")
    export OXRT_EMBREE
fi
export TSAN_OPTIONS="suppressions=$root/tests/runtime/thread_suppressions.txt:halt_on_error=1:$TSAN_OPTIONS"
export LSAN_OPTIONS="suppressions=$root/tests/runtime/leak_suppressions.txt:$LSAN_OPTIONS"
export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1:$UBSAN_OPTIONS"

for mode in ${@:-plain address thread}; do
    case $mode in
        plain) sanitize= ;;
        address) sanitize=address,undefined ;;
        thread) sanitize=thread ;;
        *) echo "unknown mode $mode: plain, address or thread" >&2; exit 2 ;;
    esac
    build=$root/build/runtime-$mode
    echo "== $mode"
    mkdir -p "$build"
    "$cmake" -S "$root" -B "$build" -DOXRT_TESTS=ON -DOXRT_SANITIZE=$sanitize
    "$cmake" --build "$build" -j2
    (cd "$build" && "$(dirname "$(command -v "$cmake")")/ctest" --output-on-failure)
done
