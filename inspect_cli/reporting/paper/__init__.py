"""A report as a PDF: typesetting, and the figures drawn for paper."""
