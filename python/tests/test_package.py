"""The package as such: its command line, its stubs, what it starts and writes."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import QUICK

import sunfleck

REPOSITORY = Path(sunfleck.__file__).resolve().parents[2]


def python(*words, **more):
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, timeout=120, **more)


def test_the_module_is_the_command_line():
    assert "usage" in python("-m", "sunfleck", "--help").stdout.lower()
    bad = python("-m", "sunfleck", "solev")
    assert bad.returncode == 2 and "solev" in bad.stderr


def test_a_version():
    assert sunfleck.__version__.count(".") == 2


def test_stubs_fit_the_module(tmp_path):
    if not shutil.which("stubtest"):
        pytest.skip("mypy's stubtest is not installed")
    (tmp_path / "mypy.ini").write_text("[mypy]\n[mypy-numpy.*]\nfollow_imports = skip\n")  # numpy's own types take a minute
    classes = "Light|Places|Run|Scene|Session"  # of pybind11's metaclass; the first two cannot be made by calling them
    (tmp_path / "known").write_text(f"sunfleck\\._core\\.({classes})\nsunfleck\\._core\\.({classes})\\.__init__\n")
    found = subprocess.run(["stubtest", "sunfleck._core", "--mypy-config-file", str(tmp_path / "mypy.ini"), "--allowlist", str(tmp_path / "known"),
                            "--ignore-unused-allowlist"], capture_output=True, text=True, timeout=300)
    assert found.returncode == 0, found.stdout + found.stderr


def test_nothing_is_started_and_nothing_written(scene, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    seen = []
    sys.addaudithook(lambda event, arguments: seen.append((event, arguments)) if event in {"subprocess.Popen", "os.fork", "os.system", "os.exec"} else None)
    result = sunfleck.solve(scene, **QUICK)
    result.png(width=32, height=24, samples=1)
    assert seen == [] and os.listdir(tmp_path) == []


def test_python_of_the_readme(tmp_path):
    """The ten lines that the README shows."""
    readme = REPOSITORY / "README.md"
    if not readme.exists():
        pytest.skip("installed without the repository")
    code = readme.read_text().split("```python\n")[1].split("```")[0]
    ran = python("-c", code, cwd=tmp_path, env={**os.environ, "PYTHONWARNINGS": "error"})
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip()


@pytest.mark.parametrize("tutorial", ["first_scene", "caribu_canopy"])
def test_tutorials_run(tutorial, tmp_path):
    file = REPOSITORY / "examples" / "python" / f"{tutorial}.py"
    if not file.exists():
        pytest.skip("installed without the repository")
    ran = python(str(file), cwd=tmp_path, env={**os.environ, "PYTHONWARNINGS": "error"})
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert ran.stdout.count("\n") >= 4 and os.listdir(tmp_path) == []
