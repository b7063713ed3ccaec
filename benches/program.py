"""A program named on the command line, for `argparse`."""

import argparse
import os
import pathlib
import shutil


def program(path):
    """The absolute path of a program that can be run."""
    found = shutil.which(path) or path
    if not (os.path.isfile(found) and os.access(found, os.X_OK)):
        raise argparse.ArgumentTypeError(f"`{path}` is not a program: build it, for example `cargo build --release`, and give target/release/trackbed")
    return pathlib.Path(found).resolve()
