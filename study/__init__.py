# SPDX-License-Identifier: MIT
"""Measures the methods of `crevice` through the tool, and draws what it found."""
