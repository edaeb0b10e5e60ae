"""Reports as HTML and PDF, drawn from a Result and a RunLog. No finding is computed here."""
