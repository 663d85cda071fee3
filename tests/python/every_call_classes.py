# SPDX-License-Identifier: GPL-2.0-or-later
"""The calls on the classes of the plugin for test_every_call.py, found by looking at them: properties, methods, signatures in docstrings."""
import collections
import re

import every_call_judge as judge
import every_call_scenes as scenes
import every_call_table as table
import every_call_values as values

Call = collections.namedtuple('Call', 'name key kind moment run')  #: run() gives (verdict, text)
#: kinds that are tried before the first step only, and those that are tried at all moments; the study tries all at all
TYPES = (
        'text', 'texts', 'none', 'list', 'empty', 'complex', 'class', 'hugeInt', 'long', 'dict', 'number', 'short', 'wide', 'nested', 'cube', 'half'
)
FEW = ('nan', 'nonsense', 'fresh')


def members(cls):
	"""(defining class, name, object) of all attributes and methods up to YADE's Serializable."""
	seen = set()
	for c in cls.__mro__:
		if c.__name__ in ('instance', 'object', 'Serializable'): continue
		for name, thing in vars(c).items():
			wanted = not name.startswith('__') or name == '__call__'
			if wanted and name not in seen and name not in table.NOT_OURS:
				seen.add(name)
				yield c, name, thing


def typeOf(prop):
	found = re.search(r':yattrtype:`([^`]*)`', prop.__doc__ or '')
	return found.group(1) if found else ''


def arguments(function):
	"""[(type, name, has a default)] from Boost.Python's signature in the docstring, without self."""
	head = (function.__doc__ or '').strip().split('\n')[0]
	inside = head[head.find('(') + 1:head.rfind(') ->')] if ') ->' in head else ''
	found = re.findall(r'\((\w+)\)(\w+)(=?)', inside)
	return [(t, n, d == '=') for t, n, d in found[1:]]


def kindsOf(typeName, value):
	own = None
	if typeName.startswith('shared_ptr<Mca'):
		import yade.wrapper
		own = getattr(yade.wrapper, typeName[11:-1], None)
	if not typeName: typeName = type(value).__name__
	return values.ofType(typeName, own)


class Calls:
	"""Makes the list for one class at one moment."""

	def __init__(self, cls, scene, moment, study):
		self.cls, (self.sceneName, self.build, self.find), self.moment, self.study = cls, scene, moment, study
		self.enter = scenes.MOMENTS[moment]
		self.refusals = {}  # of methods with right arguments, at this moment
		self.fails = None  # whether the steps fail without any call at this moment

	def start(self):
		"""(object, what follows the call) in a fresh scene."""
		from yade import O
		scenes.stop()  # YADE itself does not survive O.reset() during a run
		O.reset()
		return self.enter(self.build, self.find)

	def baseline(self):
		"""The moment without any call."""
		_, after = self.start()
		try:
			after()
		except Exception as e:
			self.fails = judge.told(e)
			return judge.refusal(e) if self.moment in table.MAY_FAIL or self.cls.__name__ in table.LATE else ('broken', self.fails)
		self.fails = ''
		return 'accepted', ''

	def bad(self, act, key, kind, atThisMoment=None):
		"""A bad value; act: function of the object. atThisMoment: refusal of right arguments as well.

		Where the steps fail without any call, only a crash can be told from right.
		"""
		if self.fails is None: self.baseline()
		thing, after = self.start()
		method = re.findall('[A-Z]?[a-z]+', key.split('(')[0].split('.')[1]) if '(' in key else ()
		accepted, still = table.accepted(key, kind, self.moment), self.moment not in ('running', 'stale', 'afterReset')
		verdict, text = judge.attempt(lambda: act(thing), after, judge.words(key), accepted, still, method)
		told = atThisMoment and atThisMoment in text and verdict == 'poor'
		return ('refused' if told or self.fails and verdict in ('silent', 'poor', 'moved') else verdict), text

	def read(self, name):
		thing, _ = self.start()
		try:
			getattr(thing, name)
		except Exception as e:
			return judge.refusal(e)
		return 'accepted', ''

	def right(self, key, name, arguments):
		"""A method with right arguments: may be refused at a bad moment, not at the first."""
		thing, after = self.start()
		try:
			getattr(thing, name)(**arguments(thing))
		except Exception as e:
			return ('broken', judge.told(e)) if self.moment == 'before' and key not in table.LATE else judge.refusal(e)
		try:
			after()
		except Exception as e:
			return ('broken' if self.fails == '' else 'refused'), judge.told(e)
		return 'accepted', ''

	def wrong(self, key, name, arguments, argument, kind, value):
		"""A method with one bad argument."""
		if self.moment != 'before' and key not in self.refusals:
			thing, _ = self.start()
			try:
				getattr(thing, name)(**arguments(thing))
				self.refusals[key] = None
			except Exception as e:
				self.refusals[key] = str(e)
		act = lambda thing: getattr(thing, name)(**dict(arguments(thing), **{argument: value}))
		return self.bad(act, '%s(%s)' % (key, argument), kind, self.refusals.get(key))

	def wanted(self, kind, key):
		if self.study or self.moment == 'before': return True
		if table.ACCEPTED.get(key, ('', ))[0] == table.ALL: return False
		return kind in FEW or self.moment == 'between' and kind not in TYPES

	def all(self):
		"""The calls, always in the same order."""
		name = self.cls.__name__
		yield self.call(name, name, 'nothing', self.baseline)
		for owner, member, thing in members(self.cls):
			what, key = '%s.%s' % (name, member), '%s.%s' % (owner.__name__, member)
			if isinstance(thing, property): yield from self.ofAttribute(what, key, member, thing)
			elif callable(thing): yield from self.ofMethod(what, key, member, thing)

	def call(self, what, key, kind, run): return Call('%s = %s | %s, %s' % (what, kind, self.sceneName, self.moment), key, kind, self.moment, run)

	def ofAttribute(self, what, key, name, thing):
		if self.moment != 'between': yield self.call(what, key, 'read', lambda: self.read(name))
		if thing.fset is None and self.moment != 'before': return
		try:
			now = getattr(self.cls(), name)
		except Exception:
			now = None
		for kind, value in kindsOf(typeOf(thing), now).items():
			set_ = lambda o, value=value: setattr(o, name, value)
			if self.wanted(kind, key): yield self.call(what, key, kind, lambda s=set_, kind=kind: self.bad(s, key, kind))
			if thing.fset is None: return  # no value can be set: one is enough

	def ofMethod(self, what, key, name, thing):
		given = arguments(thing)
		good = table.goodArguments(key, given)
		yield self.call(what, key, 'good', lambda: self.right(key, name, good))
		for typeName, argument, _ in given:
			for kind, value in kindsOf(typeName, None).items():
				if not self.wanted(kind, '%s(%s)' % (key, argument)): continue
				run = lambda a=argument, k=kind, v=value: self.wrong(key, name, good, a, k, v)
				yield self.call('%s(%s)' % (what, argument), key, kind, run)


def everyCall(study=False):
	import yade_mca  # it finds YADE
	import yade.wrapper
	for name in yade_mca.classes:
		cls = getattr(yade.wrapper, name)
		for scene in scenes.holdersOf(cls):
			for moment in scenes.momentsOf(scene[0]):
				yield from Calls(cls, scene, moment, study).all()
