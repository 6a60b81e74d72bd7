// name: category-overview
// kind: count
// description: For each kind of data that comes in, how many sources, sanitizers, leaks, findings and open elements?
// param robot: robot, only elements of this robot and findings that begin or end there; all if it is empty, default ""
// returns category: string, name of the category; what is said of narrower ones counts too
// returns sources: integer, elements that bring it in or make it of other data
// returns sanitizers: integer, elements that clean it, if it comes
// returns leaks: integer, elements that let it out, where it gets to them or a label names it
// returns elements: integer, elements that it gets to; the two sides of a wildcard count as two
// returns findings: integer, pairs of source and leak, without dismissed ones
// returns open: integer, elements that it gets to and that no label covers
// order: category
MATCH (e:Element)
WHERE $robot = '' OR e.robot = $robot
WITH labels(e) AS names, count(*) AS many
UNWIND names AS name
WITH name, sum(many) AS many
WITH collect({name: name, many: many}) AS counts
CALL () {
  MATCH (e:Element)
  WHERE size(e.open) > 0 AND ($robot = '' OR e.robot = $robot)
  WITH e.open AS kinds,
       count(DISTINCT coalesce(e.robot, '') + ' ' + e.kind + ' ' + e.name + coalesce(' ' + e.leg, '')) AS many
  CALL (kinds) {
    UNWIND kinds AS kind
    MATCH (:DataCategory {name: kind})-[:BROADER*0..]->(c:DataCategory)
    RETURN DISTINCT c.name AS name
  }
  WITH name, sum(many) AS many
  RETURN collect({name: name, many: many}) AS opens
}
MATCH (c:DataCategory)
WITH c, c.name AS category,
     coalesce([x IN counts WHERE x.name = c.label + 'Source' | x.many][0], 0) AS sources,
     coalesce([x IN counts WHERE x.name = c.label + 'Sanitizer' | x.many][0], 0) AS sanitizers,
     coalesce([x IN counts WHERE x.name = c.label + 'Leak' | x.many][0], 0) AS leaks,
     coalesce([x IN counts WHERE x.name = c.label | x.many][0], 0) AS elements,
     coalesce([x IN opens WHERE x.name = c.name | x.many][0], 0) AS open
WHERE sources + elements > 0
CALL (c) {
  MATCH (c)<-[:BROADER*0..]-(k:DataCategory)
  WITH DISTINCT k
  MATCH (k)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
  WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
  RETURN count(f) AS findings
}
RETURN category, sources, sanitizers, leaks, elements, findings, open
ORDER BY category
