"""The mission executive: modes and failsafes as tables. It is handed a Guidance."""
