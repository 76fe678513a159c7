# SPDX-License-Identifier: MIT
def add_arguments(parser): parser.add_argument("--docs", action="store_true")
def main(arguments): return 0
