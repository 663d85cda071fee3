# SPDX-License-Identifier: GPL-2.0-or-later
"""`info`: what is installed and what a run would use."""
import platform
import time

from . import environment, registry

SUMMARY = registry.SUMMARIES['info']


def addArguments(parser):
	pass


def facts():
	"""Everything as a dict of strings, numbers and lists. Loads YADE and the plugin; raises ImportError when they do not fit."""
	start = time.perf_counter()
	import yade_mca
	import yade.config
	from .. import materials
	return dict(version=environment.version(), commit=environment.commit(), yade=yade.config.version, python=platform.python_version(),
	            loadSeconds=time.perf_counter() - start, guardChecks=getattr(yade_mca, 'guardChecks', 0), classes=sorted(getattr(yade_mca, 'classes', [])),
	            isa=environment.isa(), threads=environment.threads(), processors=environment.cores(), processor=environment.processor(),
	            materials=materials.names(), tasks=list(registry.TASKS))


def run(args, report, progress):
	f = facts()
	report.extra['info'] = f
	for key, value in f.items():
		if key != 'loadSeconds':
			print('%-12s %s' % (key, ', '.join(value) if isinstance(value, list) else value))
	report.add('guardChecks', f['guardChecks'], unit='comparisons', passed=f['guardChecks'] > 0)
	report.add('classes', len(f['classes']), unit='classes', passed=len(f['classes']) > 0)
	report.add('materials', len(f['materials']), unit='materials', passed=len(f['materials']) > 0)
