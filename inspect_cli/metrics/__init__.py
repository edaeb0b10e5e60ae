"""From a RunLog to a Result: tracking, contact, corrosion, acceptance."""
