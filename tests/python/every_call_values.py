# SPDX-License-Identifier: GPL-2.0-or-later
"""Bad values by type for test_every_call.py: each kind has a name by which every_call_table.py may declare it accepted."""
import numpy as np

NAN, INF, HUGE = float('nan'), float('inf'), 1e300

#: what no attribute or argument of a number can be
NO_NUMBER = {'text': 'x', 'none': None, 'list': [1.], 'empty': (), 'complex': 1j, 'class': object()}
FLOAT = {'nan': NAN, 'inf': INF, '-inf': -INF, 'huge': HUGE, '-huge': -HUGE, 'negative': -1., 'zero': 0., 'hugeInt': 10**400, **NO_NUMBER}
INT = {
        'negative': -1, '-2': -2, 'zero': 0, 'huge': 2**31 - 1, '-huge': -2**31, 'hugeInt': 10**30, 'long': 2**40, 'half': 0.5, 'nan': NAN, 'inf': INF,
        **NO_NUMBER
}
BOOL = {'text': 'x', 'list': [True], 'half': 0.5, 'nan': NAN, 'class': object()}  # None and whole numbers count by their truth in Boost.Python
TEXT = {'empty': '', 'nonsense': 'nonsense', 'number': 5, 'none': None, 'long': 'x' * 10000, 'list': ['left']}  # Boost.Python takes bytes as text
NO_VECTOR = {'short': (1.,), 'text': 'ab', 'number': 1., 'none': None, 'empty': (), 'nested': ((1., 2.), (3., 4.)), 'texts': ('a', 'b')}


def vector(n):
	rest = (0.,) * (n - 1)
	numbers = {'nan': (NAN, *rest), 'inf': (INF, *rest), '-inf': (*rest, -INF), 'huge': (HUGE, *rest), 'negative': (-1., *rest), 'zero': (0., *rest)}
	return {**numbers, 'wide': (1., ) * (n + 2), **NO_VECTOR}


IDS = {
        'negative': [-1], 'huge': [2**31 - 1], 'long': [2**40], 'nan': [NAN], 'half': [0.5], 'empty': [], 'twice': [1, 1], 'nested': [[1]], 'texts': ['x'],
        'number': 5, 'text': 'ab', 'none': None
}
#: for arguments that are looked at in Python: numbers, sequences, histories
ANY = {
        **{k: FLOAT[k] for k in ('nan', 'inf', '-inf', 'huge', '-huge', 'negative', 'zero', 'hugeInt')}, 'half': 0.5, 'text': 'x', 'none': None,
        'complex': 1j, 'class': object(), 'dict': {}, 'empty': (), 'one': [1.], 'three': (1., 2., 3.), 'nans': [NAN, NAN], 'infs': [INF, 0.],
        'nested': [[1., 2.], [3.]], 'texts': ['a', 'b'], 'cube': np.ones((2, 2, 2))
}


def quaternion():
	from yade.wrapper import State
	Quaternion = type(State().ori)
	return {'nan': Quaternion((0, 0, 1), NAN), 'inf': Quaternion((0, 0, 1), INF), 'huge': Quaternion((0, 0, HUGE), 1.), **NO_VECTOR}


def objects(own):
	"""Instead of an object of a class of YADE; `own`: makes a fresh one of the right class, or None."""
	from yade.wrapper import Body, Sphere
	kinds = {'none': None, 'number': 1., 'text': 'x', 'wrongClass': Sphere(), 'body': Body(), 'list': []}
	if own: kinds['fresh'] = own()
	return kinds


def ofType(name, own=None):
	"""Kinds for a type as YADE's documentation (`Real`, `vector<int>`) or a signature of Boost.Python (`float`, `Vector2`) names it."""
	name = name.strip()
	if name in ('Real', 'float', 'double'): return FLOAT
	if name in ('int', 'long', 'unsigned', 'unsigned int', 'size_t'): return INT
	if name == 'bool': return BOOL
	if name in ('string', 'str', 'std::string'): return TEXT
	if name.startswith('Vector') and name[6:7].isdigit(): return vector(int(name[6]))
	if name == 'vector<int>': return IDS
	if name.startswith('Quaternion'): return quaternion()
	if own or name.startswith('shared_ptr') or name[:1].isupper(): return objects(own)
	return ANY
