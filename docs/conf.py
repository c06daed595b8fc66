"""The manual, by ``make docs``. Sphinx: the docstrings use its roles, it runs the notebooks, and it will be kept up."""

import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]
# What the tutorials run as a command is that of this environment, whether or not it is activated.
os.environ["PATH"] = os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", "")))

import generated  # noqa: E402

from dexrepro import __version__  # noqa: E402

project, release, html_title = "dexrepro", __version__, "dexrepro"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.viewcode"]
exclude_patterns = ["schemas", "_build"]
myst_heading_anchors = 3
myst_enable_extensions = ["attrs_inline"]
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_merge_streams = True
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": True}
html_theme = "furo"
html_copy_source = False
html_show_copyright = False
smartquotes = False  # --json is two hyphens
suppress_warnings = ["mystnb.unknown_mime_type"]

generated.write(HERE)


def setup(app):
    """Docstrings are prose: what is markup only by accident is taken as it stands."""
    app.connect("autodoc-process-docstring", generated.as_prose)
