"""What a report consists of before it is a page: blocks of text, tables and figures."""
