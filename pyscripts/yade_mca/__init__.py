# SPDX-License-Identifier: GPL-2.0-or-later
"""Movable cellular automata coupled with a Lagrangian grid, for YADE.

``import yade_mca`` loads the compiled classes into the YADE of this process (it starts YADE in a plain ``/usr/bin/python3``). Afterwards their names are
known here, in ``yade.wrapper``, ``yade.utils`` and everywhere in the script, as YADE's own are.
Raises ImportError, saying what differs and what to do, when the plugin does not fit the YADE at hand.
"""
from yade_mca import _loader

_loader.setThreadPolicy()
_extension, _manifest = _loader.load()
classes = list(_extension.classes)  #: names of the YADE classes this plugin brings
guardChecks = _extension.guardChecks  #: number of comparisons made between the plugin and this YADE at import
version = _manifest['version']  #: version of the plugin
commit = _manifest['commit']  #: revision of the source tree it was built from, or None
_loader.publish(classes, globals())
