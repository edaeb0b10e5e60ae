"""Contact-based non-destructive testing by flying robots: plan, fly, report, regress."""
