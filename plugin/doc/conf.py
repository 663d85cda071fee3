# SPDX-License-Identifier: GPL-2.0-or-later
"""Sphinx configuration. `pyscripts/run docs` builds the HTML; warnings are errors. Pages in _generated are made anew in each build by generate.py."""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [HERE, os.path.join(ROOT, 'pyscripts')]
import generate

project = 'yade-mca'
author = copyright = 'the yade-mca authors'
version = release = re.search(r'VERSION (\d[\d.]*) LANGUAGES', open(os.path.join(ROOT, 'CMakeLists.txt')).read()).group(1)
extensions = ['sphinx.ext.mathjax', 'sphinx.ext.autodoc']
exclude_patterns = ['_generated']
html_theme = 'alabaster'
html_theme_options = {'page_width': '1150px', 'sidebar_width': '230px', 'description': 'Movable cellular automata and a Lagrangian grid in YADE'}
html_copy_source = False
nitpicky = True
nitpick_ignore = [('py:class', 'object')]
autodoc_member_order = 'bysource'
autodoc_typehints = 'none'
add_module_names = False
highlight_language = 'python'


def literal(app, what, name, obj, options, lines):
	"""Docstrings are plain text: the first paragraph as it is, the rest with its line breaks."""
	lines[:] = generate.plain('\n'.join(lines)).splitlines()


def setup(app):
	generate.everything(os.path.join(HERE, '_generated'))
	app.connect('autodoc-process-docstring', literal)
