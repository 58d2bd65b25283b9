#!/usr/bin/env bash
# Builds the wheel, installs it alone into a new environment outside the checkout, and runs the
# fast tests against it there. Usage: wheel.sh PYTHON [pinned|oldest|newest]
# Dependencies are those of constraints.txt, the oldest that pyproject.toml allows, or the newest.
# On Linux on x86-64 the wheel has compiled kernels, but with the newest dependencies it is pure.
set -euo pipefail
python=$PWD/$1
versions=${2:-pinned}
root=$PWD
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

compiled=
if [ "$versions" != newest ] && [ "$(uname -sm)" = "Linux x86_64" ]; then
  compiled=true
  export HATCH_BUILD_HOOK_ENABLE_CUSTOM=true
fi
"$python" -m build --wheel --no-isolation --outdir "$place" "$root" >/dev/null
"$python" -m venv "$place/env"
bin=$place/env/bin
[ -d "$bin" ] || bin=$place/env/Scripts
wheel=$(ls "$place"/*.whl)
case $versions in
  pinned) cp constraints.txt "$place" ;;
  oldest) "$python" packaging/oldest.py >"$place/constraints.txt" ;;
  newest) : >"$place/constraints.txt" ;;
esac
"$bin/python" -m pip install --quiet --disable-pip-version-check -c "$place/constraints.txt" "$wheel[dev]"

# What the tests read besides the packages; node_modules is lent, not copied.
mkdir "$place/checkout"
cp -r pyproject.toml docs editors examples benchmarks lexicons "$place/checkout"
tar --exclude=node_modules --exclude=__pycache__ -cf - tests | tar -xf - -C "$place/checkout"
if [ -d tests/node/node_modules ]; then
  ln -s "$root/tests/node/node_modules" "$place/checkout/tests/node/node_modules"
fi

cd "$place/checkout"
"$bin/python" -c "import azee, sys; sys.exit('site-packages' not in azee.__file__)"
told=$("$bin/azee" compile -e ":bonjour" -o "$place/bonjour.bvh" 2>&1)
case $compiled$told in
  true*"Preparing the solver"*) echo "$told: the wheel's kernels were not used" >&2; exit 1 ;;
esac
"$bin/python" -m pytest -q -n auto -m "not slow" -o pythonpath=examples --ignore tests/project --ignore tests/mutants
