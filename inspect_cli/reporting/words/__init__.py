"""The words of a report: languages, sentences, numbers, and English from results known again."""
