# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `verify`: exact solutions, balances and cost of automata, grid and interface. It starts in task.py."""
