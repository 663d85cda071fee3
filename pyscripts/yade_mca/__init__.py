# SPDX-License-Identifier: GPL-2.0-or-later
"""Movable cellular automata coupled with a Lagrangian grid, for YADE.

``import yade_mca`` loads the compiled classes into the YADE of this process (it starts YADE in a plain ``/usr/bin/python3``). Afterwards their names are
known here, in ``yade.wrapper``, ``yade.utils`` and everywhere in the script, as YADE's own are.
Raises ImportError, saying what differs and what to do, when the plugin does not fit the YADE at hand.

What only computes needs no YADE: ``from yade_mca import measure`` or ``import yade_mca.packings`` loads nothing in a process without YADE. The classes are
loaded then when the first of them is asked for (``from yade_mca import McaEngine``, or a function that makes one), or when the script imports ``yade``,
whichever comes first, with the same names in the same places and the same errors. Where YADE runs already, any import of the package loads them at once.
(Python runs this file once: after ``from yade_mca import measure`` an ``import yade_mca`` changes nothing, and the classes still wait for their first use.)
"""
import sys

from yade_mca import _loader

LOADED = ('classes', 'guardChecks', 'version', 'commit')  # names here, besides those of the classes, that are known when the plugin is loaded


def _load():
	"""Loads the compiled classes and makes their names known. Raises ImportError with a remedy."""
	global classes, guardChecks, version, commit
	_loader.WithYade.remove()
	extension, manifest = _loader.load()
	classes = list(extension.classes)  #: names of the YADE classes this plugin brings
	guardChecks = extension.guardChecks  #: number of comparisons made between the plugin and this YADE when it was loaded
	version = manifest['version']  #: version of the plugin
	commit = manifest['commit']  #: revision of the source tree it was built from, or None
	_loader.publish(classes, globals())


def __getattr__(name):
	"""Called for a name that is not here (yet). All classes have Mca in theirs; others are modules of the package or nothing."""
	if (name in LOADED or 'Mca' in name) and 'classes' not in globals(): _load()
	if name in globals(): return globals()[name]
	raise AttributeError("module 'yade_mca' has no attribute '%s'" % name)


_loader.setThreadPolicy()
if 'yade' in sys.modules or _loader.asksForAll(sys._getframe(1)): _load()
else: _loader.WithYade.place(_load)
