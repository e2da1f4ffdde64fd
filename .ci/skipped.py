"""Fail if too large a fraction of the tests was skipped: python .ci/skipped.py JUNIT.xml 0.01."""

import sys
from xml.etree import ElementTree

if __name__ == "__main__":
    suites = list(ElementTree.parse(sys.argv[1]).iter("testsuite"))
    total, skipped = (sum(int(suite.get(name, 0)) for suite in suites) for name in ("tests", "skipped"))
    print(f"{skipped} of {total} tests were skipped ({skipped / total:.2%})")
    sys.exit(skipped > float(sys.argv[2]) * total)
