# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `penetration`: a tungsten rod through a steel plate. It starts in task.py."""
