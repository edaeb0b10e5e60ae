"""Contact-based non-destructive testing by flying robots: plan, fly, report, regress."""

import os

# Numba reads this when it is first imported, wherever that is. Our kernels are short chains of
# 3-vectors: at level 1 they run as fast as at level 3 and compile a quarter sooner. A user's own
# setting wins.
os.environ.setdefault("NUMBA_OPT", "1")
