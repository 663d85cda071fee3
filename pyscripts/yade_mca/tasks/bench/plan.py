# SPDX-License-Identifier: GPL-2.0-or-later
"""Which runs `bench` makes: a job is a dict that names the case, the solver, the resolution n and the options; one process per job."""

#: case -> share of the largest stable time step where nothing else is said
FACTORS = dict(elasticWave=0.4, plasticShock=0.4, taylorBar=0.4, plateWave=0.4, penetration=0.3, law=0.1, space=0.1)
LAWS = ('law', 'space')  #: cost of a step alone
GRID_FACTOR = 0.6
UNTIL = 42.  #: end of penetration [us]
RULES = ('inversePower', 'meanDistance')
WIDTHS = (120, 200, 400)  #: of plates [mm]
CASES = tuple(FACTORS)
#: what n counts
RESOLUTION = dict(elasticWave='spacings in the width of the pulse', plasticShock='automata or cells along the bar', taylorBar='automata across the bar', plateWave='automata over the thickness',
                  penetration='automata over the thickness', law='automata', space='automata')
#: case -> until when or what the error is
ERRORS = dict(elasticWave='L2 error of the velocities against the exact solution', plasticShock='L1 error of the velocities against the exact solution', taylorBar='length and foot against the finest run',
              plateWave='L2 error of velocities at three points against the finest run', penetration='losses of the rod against the finest run')


def job(case, solver, n, **options):
	"""A job with its defaults; `mayEnd`: an error of the engine is a result, not a failure."""
	j = dict(case=case, solver=solver, n=n, rule='affine', factor=GRID_FACTOR if solver == 'grid' else FACTORS[case], sleeping=True, account=case == 'penetration', threads=1, mayEnd=False)
	if case == 'plateWave': j['width'] = 120
	if case == 'penetration': j.update(width=120, until=UNTIL)
	if case in LAWS: j.update(kind='plastic', sleeping=False, account=False)
	if not set(options) <= {*j, 'short'}:
		raise ValueError('unknown options %s' % sorted(set(options) - set(j)))
	j.update(options)
	return j


def variants(j):
	"""Words for what differs from the default of the job, [] for a default one."""
	words = [j['kind']] if j.get('kind', 'plastic') != 'plastic' else []
	if j['rule'] != 'affine': words.append(j['rule'])
	if j['factor'] != (GRID_FACTOR if j['solver'] == 'grid' else FACTORS[j['case']]): words.append('dt%g' % j['factor'])
	if not j['sleeping'] and j['case'] not in LAWS: words.append('awake')
	if j['account'] != (j['case'] == 'penetration'): words.append('account' if j['account'] else 'noAccount')
	if j['threads'] != 1: words.append('%dthreads' % j['threads'])
	return words


def name(j):
	width = (['w%d' % j['width']] if 'width' in j else []) + ['%gus' % j.get('until', UNTIL)] * (j.get('until', UNTIL) != UNTIL)
	return '/'.join([j['case'], j['solver'], *width, 'N%d' % j['n'], *variants(j)])


def series(case, solver, sizes, **options):
	return [job(case, solver, n, **options) for n in sizes]


def rulesAndSteps(case, solver, n, factors, **options):
	"""Volume rules and time-step factors at one resolution; both ends of the range may end a run."""
	return ([job(case, solver, n, rule=r, mayEnd=r == 'meanDistance', **options) for r in RULES] if solver != 'grid' else []) + [
	        job(case, solver, n, factor=f, mayEnd=f > 0.5, **options) for f in factors]


def quick():
	jobs = series('elasticWave', 'automata', (3, 6, 12)) + series('elasticWave', 'grid', (3, 6, 12)) + series('elasticWave', 'coupled', (6, 12))
	jobs += series('elasticWave', 'Law2', (3, )) + series('elasticWave', 'CpmMat', (3, 6)) + rulesAndSteps('elasticWave', 'automata', 6, (0.1, 0.7, 1.))
	jobs += [job('elasticWave', 'automata', 12, sleeping=False), job('elasticWave', 'automata', 12, threads=2)]
	jobs += series('plasticShock', 'automata', (100, 200)) + series('plasticShock', 'grid', (100, 200)) + rulesAndSteps('plasticShock', 'automata', 100, (0.1, 0.9))
	jobs += series('taylorBar', 'automata', (8, 12, 18))
	for w in (120, 400):
		jobs += series('plateWave', 'automata', (12, 24, 48), width=w) + series('plateWave', 'coupled', (12, 24), width=w)
	jobs += series('penetration', 'coupled', (12, 25), until=20.) + series('penetration', 'automata', (12, 25), until=20.) + [job('penetration', 'coupled', 25, until=20., threads=2)]
	jobs += [job('penetration', 'coupled', 12, until=20., sleeping=False), job('penetration', 'coupled', 12, until=20., rule='inversePower')]
	roads = [job('law', 'McaEngine', 10000)] + [job('law', r, 10000, short=True) for r in ('Law2', 'CpmMat', 'CohFrictMat')]
	return jobs + roads + [job('law', 'McaEngine', 10000, **o) for o in (dict(threads=2), dict(kind='elastic'), dict(kind='fracture'), dict(kind='random'))] + [
	        job('space', 'McaEngine', 10000, threads=t) for t in (1, 2)]


def waves():
	jobs = [j for s in ('automata', 'grid', 'coupled') for j in series('elasticWave', s, (3, 6, 12)) + series('elasticWave', s, (24, ))]
	jobs += series('elasticWave', 'Law2', (3, 6, 12)) + series('elasticWave', 'CpmMat', (3, 6, 12)) + series('elasticWave', 'CohFrictMat', (6, ))
	jobs += rulesAndSteps('elasticWave', 'automata', 6, (0.1, 0.2, 0.6, 0.8, 1.)) + rulesAndSteps('elasticWave', 'automata', 12, (0.1, 0.8))
	jobs += rulesAndSteps('elasticWave', 'grid', 6, (0.1, 0.3, 0.8, 1.))
	jobs += [job('elasticWave', s, 12, sleeping=False) for s in ('automata', 'grid')] + [job('elasticWave', s, n, threads=2) for s in ('automata', 'grid', 'coupled') for n in (12, 24)]
	jobs += series('plasticShock', 'automata', (100, 200, 400, 800)) + series('plasticShock', 'grid', (100, 200, 400, 800))
	jobs += rulesAndSteps('plasticShock', 'automata', 200, (0.1, 0.2, 0.6, 0.8, 1.)) + rulesAndSteps('plasticShock', 'grid', 200, (0.1, 0.3, 0.8, 1.))
	return jobs + [job('plasticShock', s, 800, **o) for s in ('automata', 'grid') for o in (dict(threads=2), dict(sleeping=False))]


def bodies():
	jobs = series('taylorBar', 'automata', (8, 12, 18, 27, 40)) + rulesAndSteps('taylorBar', 'automata', 18, (0.1, 0.2, 0.7, 1.))
	jobs += [job('taylorBar', 'automata', 27, **o) for o in (dict(threads=2), dict(sleeping=False), dict(account=True))]
	for w in WIDTHS:
		finest = (96, ) if w == 120 else ()
		jobs += series('plateWave', 'automata', (12, 24, 48, *finest), width=w) + series('plateWave', 'coupled', (12, 24, *((48, ) if finest else ())), width=w)
	jobs += [job('plateWave', s, 24, width=400, **o) for s in ('automata', 'coupled') for o in (dict(threads=2), dict(account=True))]
	jobs += series('penetration', 'coupled', (12, 25, 50, 100)) + series('penetration', 'automata', (12, 25, 50)) + rulesAndSteps('penetration', 'coupled', 25, (0.1, 0.2, 0.6, 0.8, 1.))
	jobs += [job('penetration', 'coupled', 25, **o) for o in (dict(threads=2), dict(sleeping=False), dict(account=False))] + [job('penetration', 'coupled', 50, threads=2)]
	return jobs + [job('penetration', s, n, width=w) for w in WIDTHS[1:] for s in ('automata', 'coupled') for n in (25, 50)]


def spaces():
	return [job('space', 'McaEngine', n, kind=kind, threads=t) for n in (10000, 100000) for kind in ('plastic', 'elastic', 'johnsonCook') for t in (1, 2)]


def laws():
	jobs = []
	for n in (10000, 100000):
		for kind in ('plastic', 'elastic', 'fracture', 'random'):
			for road in ('McaEngine', 'Law2') + (('CpmMat', 'CohFrictMat') if kind == 'plastic' else ()):
				if road == 'McaEngine' or kind == 'plastic' or (kind != 'random' and n == 10000): jobs += [job('law', road, n, kind=kind, threads=t) for t in (1, 2)]
	return jobs + [job('law', 'McaEngine', 1000000, kind=kind, threads=t) for kind in ('plastic', 'elastic', 'fracture', 'random') for t in (1, 2)]


def plan(isQuick, only=None, cores=2):
	"""The jobs in order; only: names of cases or None; jobs with more threads than processors are left out."""
	jobs = quick() if isQuick else waves() + bodies() + laws() + spaces()
	return [j for j in jobs if (not only or j['case'] in only) and j['threads'] <= cores]
