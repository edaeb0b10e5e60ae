"""File models (mission, truth, platform, plan, result) and the strict YAML that fills them."""
