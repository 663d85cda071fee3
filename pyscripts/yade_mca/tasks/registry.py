# SPDX-License-Identifier: GPL-2.0-or-later
"""Which tasks there are. A task's module is imported only when it is run."""
import importlib
import importlib.util

#: task -> module of this package; tasks of several files have a folder each
TASKS = {
        'penetration': 'penetration.task',
        'table1': 'table1',
        'study': 'study',
        'verify': 'verify.task',
        'bench': 'bench.task',
        'stress': 'stress.task',
        'info': 'info',
        'check': 'check',
        'docs': 'docs',
        'readme': 'readme',
        'abi': 'abi',
}
SUMMARIES = {
        'penetration': 'a tungsten rod through a steel plate: losses of speed and length, pictures, animation, page',
        'table1': 'six plate thicknesses in both modes beside the published table',
        'study': 'how the penetration result depends on spacing, seeds, options and width',
        'verify': 'automata in plane strain and in space, fracture, grid, interface or all against exact solutions',
        'bench': 'run time against error, cost by phase',
        'stress': 'numerical stability: what holds, what is refused, what fails',
        'info': 'versions, instruction level, threads, classes, materials',
        'check': 'the examples with coarse settings against the numbers they expect',
        'docs': 'this documentation as HTML',
        'readme': 'tables and pictures of README.md from the results of other tasks',
        'abi': 'what an installed YADE of any version has other than the plugin declares',
}
#: parts of `verify`, in the order in which `all` runs them; part -> modules with CASES, functions of (report, want, quick) each
PARTS = {
        'automata': ('verify.automata_elastic', 'verify.automata_balance', 'verify.automata_roads', 'verify.automata_shocks', 'verify.automata_impact', 'verify.automata_surfaces'),
        'automata3d': ('verify.space_elastic', 'verify.space_balance', 'verify.space_shocks'),
        'fracture': ('verify.fracture_cracks', 'verify.fracture_fragments'),
        'grid': ('verify.grid_waves', 'verify.grid_lamb', 'verify.grid_shocks', 'verify.grid_shell', 'verify.grid_cost'),
        'interface': ('verify.interface_block', 'verify.interface_waves'),
}


class UsageError(Exception):
	"""A wrong option: ends the task with its message in one line and status 2."""


def load(module):
	"""The module of a task or of a part of it. Raises UsageError when this installation does not have it."""
	name = __package__ + '.' + module
	try:
		found = importlib.util.find_spec(name)
	except ModuleNotFoundError:  # its folder is missing
		found = None
	if found is None:
		raise UsageError("'%s' is not part of this installation (module %s is missing)" % (module.split('.')[0], name))
	return importlib.import_module(name)
