# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the package share: the program, whose numbers Python's must be."""

import json
import os
import pickle
import shutil
import subprocess

import pytest

import petzval as pz


def pytest_configure(config):
    config.addinivalue_line("filterwarnings", "ignore::petzval.Note")


class Program:
    """The program of the same build, run in a folder of the test."""

    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *arguments):
        environment = dict(os.environ, PETZVAL_DATA=pz.data_directory())
        done = subprocess.run([self.path, *map(str, arguments)], cwd=self.folder, env=environment, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def json(self, *arguments):
        return json.loads(self.run(*arguments, "--json"))


@pytest.fixture
def program(tmp_path):
    path = os.environ.get("PETZVAL_PROGRAM") or shutil.which("petzval")
    if not path:
        pytest.skip("PETZVAL_PROGRAM names no program to compare with")
    return Program(path, tmp_path)


@pytest.fixture(scope="session")
def sensor():
    return pz.Sensor("example-vga", {"columns": 96, "rows": 64, "pitch_um": 40})


@pytest.fixture
def camera(sensor):
    return pz.Camera("edmund-54852", f_number=4, focus="1.2m", sensor=sensor)


@pytest.fixture(scope="session")
def light_of_session(sensor):
    camera = pz.Camera("edmund-54852", f_number=4, focus="1.2m", sensor=sensor)
    return camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]))


@pytest.fixture
def light(light_of_session):
    return pickle.loads(pickle.dumps(light_of_session))
