# SPDX-License-Identifier: GPL-2.0-or-later
"""Which tasks there are. A task's module is imported only when it is run."""
import importlib
import importlib.util

#: task -> module of this package
TASKS = {
        'penetration': 'penetration',
        'table1': 'table1',
        'study': 'study',
        'verify': 'verify',
        'bench': 'bench',
        'stress': 'stress',
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
        'verify': 'automata, grid, interface or all against exact solutions',
        'bench': 'run time against error, cost by phase',
        'stress': 'numerical stability: what holds, what is refused, what fails',
        'info': 'versions, instruction level, threads, classes, materials',
        'check': 'the examples with coarse settings against the numbers they expect',
        'docs': 'this documentation as HTML',
        'readme': 'tables and pictures of README.md from the results of other tasks',
        'abi': 'what an installed YADE of any version has other than the plugin declares',
}
#: parts of `verify`, in the order in which `all` runs them; part -> module
PARTS = {'automata': 'verify_automata', 'grid': 'verify_grid', 'interface': 'verify_interface'}


class UsageError(Exception):
	"""A wrong option: ends the task with its message in one line and status 2."""


def load(module):
	"""The module of a task or part. Raises UsageError when this installation does not have it."""
	name = __package__ + '.' + module
	if importlib.util.find_spec(name) is None:
		raise UsageError("'%s' is not part of this installation (module %s is missing)" % (module.replace('_', ' '), name))
	return importlib.import_module(name)
